//! How long work goes on: bars on a terminal, a plain line now and then elsewhere.

use std::collections::BTreeMap;
use std::io::{self, IsTerminal};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use covimap_map::{Observer, Stage};
use indicatif::{ProgressBar, ProgressStyle};

use crate::console::{Console, complain};
use crate::interrupt::{self, Deferral};

/// Between two plain lines; short enough for watchdogs that end silent jobs.
const PLAIN_EVERY: Duration = Duration::from_secs(10);
/// Between two pictures of the bar.
const DRAW_EVERY: Duration = Duration::from_millis(100);

/// Watches work for the person who started it, and stops a build on Ctrl-C.
pub struct Progress {
    state: Arc<Mutex<State>>,
    ticker: Option<Ticker>,
    _deferral: Deferral,
}

#[derive(Default)]
struct State {
    running: Option<Running>,
    /// Time in all runs of a stage: one run a component of the log.
    times: BTreeMap<Stage, Duration>,
}

#[derive(Debug, Clone, Copy)]
struct Running {
    name: &'static str,
    unit: &'static str,
    total: Option<u64>,
    done: u64,
    since: Instant,
}

impl Progress {
    /// A bar if standard error is a terminal, else plain lines; nothing if the console is quiet.
    pub fn new(console: Console) -> Self {
        let state = Arc::<Mutex<State>>::default();
        let seen = state.clone();
        let running = move || lock(&seen).running;
        let ticker = match (console.quiet, io::stderr().is_terminal()) {
            (true, _) => None,
            (false, true) => {
                let mut bar = Bar::new();
                Some(Ticker::start(DRAW_EVERY, move || bar.draw(running())))
            }
            (false, false) => {
                let say = move |running: Running| complain(line(&running));
                Some(Ticker::start(PLAIN_EVERY, move || running().into_iter().for_each(say)))
            }
        };
        Self { state, ticker, _deferral: Deferral::of_work() }
    }

    /// A piece of work starts; `total` is its amount, where known. [`Observer::advanced`] tells how it goes on.
    pub fn begin(&self, name: &'static str, unit: &'static str, total: Option<u64>) {
        lock(&self.state).running = Some(Running { name, unit, total, done: 0, since: Instant::now() });
    }

    /// Ends the display and returns the time that each stage took, in order.
    pub fn end(self) -> Vec<(Stage, Duration)> {
        drop(self.ticker);
        std::mem::take(&mut lock(&self.state).times).into_iter().collect()
    }
}

impl Observer for Progress {
    fn started(&self, stage: Stage, total: Option<u64>) {
        self.begin(name(stage), unit(stage), total);
    }

    fn advanced(&self, amount: u64) {
        if let Some(running) = &mut lock(&self.state).running {
            running.done += amount;
        }
    }

    fn finished(&self, stage: Stage) {
        let mut state = lock(&self.state);
        if let Some(running) = state.running.take() {
            *state.times.entry(stage).or_default() += running.since.elapsed();
        }
    }

    fn interrupted(&self) -> bool {
        interrupt::requested()
    }
}

/// Calls a function now and then in a thread of its own, until it is dropped.
struct Ticker {
    ended: Arc<(Mutex<bool>, Condvar)>,
    thread: Option<JoinHandle<()>>,
}

impl Ticker {
    fn start(every: Duration, mut tick: impl FnMut() + Send + 'static) -> Self {
        let ended = Arc::<(Mutex<bool>, Condvar)>::default();
        let watched = ended.clone();
        let thread = thread::spawn(move || {
            let (ended, changed) = &*watched;
            let mut end = lock(ended);
            while !*end {
                let waited = changed.wait_timeout_while(end, every, |end| !*end).expect(NO_PANIC);
                end = waited.0;
                if waited.1.timed_out() {
                    tick();
                }
            }
        });
        Self { ended, thread: Some(thread) }
    }
}

impl Drop for Ticker {
    fn drop(&mut self) {
        *lock(&self.ended.0) = true;
        self.ended.1.notify_all();
        if let Some(thread) = self.thread.take() {
            thread.join().expect(NO_PANIC);
        }
    }
}

/// The bar on the terminal; leaves nothing behind.
struct Bar {
    bar: ProgressBar,
    shown: Option<&'static str>,
}

impl Bar {
    fn new() -> Self {
        Self { bar: ProgressBar::new(0), shown: None }
    }

    fn draw(&mut self, running: Option<Running>) {
        let Some(Running { name, unit, total, done, .. }) = running else { return };
        if self.shown.replace(name) != Some(name) {
            self.bar.reset();
            self.bar.set_message(name);
            self.bar.set_style(style(unit, total));
        }
        self.bar.set_length(total.unwrap_or(0));
        self.bar.set_position(done);
        self.bar.tick();
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn style(unit: &str, total: Option<u64>) -> ProgressStyle {
    let template = match (unit, total) {
        (BYTES, Some(_)) => "{msg:<10} {bar:32} {bytes} of {total_bytes}, {eta} left",
        (BYTES, None) => "{msg:<10} {spinner} {bytes}, {elapsed}",
        (_, Some(_)) => "{msg:<10} {bar:32} {human_pos} of {human_len}, {eta} left",
        (_, None) => "{msg:<10} {spinner} {elapsed}",
    };
    ProgressStyle::with_template(template).expect("templates are valid (bug in covimap)")
}

/// What is going on, as a line of text.
fn line(running: &Running) -> String {
    let &Running { name, unit, total, done, since } = running;
    let elapsed = since.elapsed();
    let seconds = elapsed.as_secs();
    match total {
        Some(total) => {
            let left = remaining(elapsed, done, total)
                .map_or(String::new(), |left| format!(", about {} s left", left.as_secs()));
            format!("covimap: {name}: {done} of {total} {unit}, {seconds} s{left}")
        }
        None if done > 0 => format!("covimap: {name}: {done} {unit}, {seconds} s"),
        None => format!("covimap: {name}: {seconds} s"),
    }
}

/// How long the rest will take if it goes on like this; unknown before anything is done.
fn remaining(elapsed: Duration, done: u64, total: u64) -> Option<Duration> {
    (done > 0).then(|| elapsed.mul_f64(total.saturating_sub(done) as f64 / done as f64))
}

/// What people call a stage.
pub fn name(stage: Stage) -> &'static str {
    match stage {
        Stage::Read => "read",
        Stage::Count => "count",
        Stage::Regions => "regions",
        Stage::LocalMaps => "local maps",
        Stage::Stitch => "stitch",
        Stage::Variants => "variants",
        Stage::Lift => "lift",
        Stage::Polish => "polish",
        Stage::Distances => "distances",
        Stage::Refine => "refine",
        Stage::Ranges => "ranges",
        Stage::Classical => "classical",
        Stage::Sensor => "sensor",
    }
}

/// The unit that is shown as kB, MB and so on.
const BYTES: &str = "bytes";

fn unit(stage: Stage) -> &'static str {
    match stage {
        Stage::Read => BYTES,
        Stage::Count => "landmarks",
        Stage::LocalMaps => "regions",
        Stage::Variants => "regions and pieces",
        Stage::Refine => "iterations at most",
        Stage::Ranges => "rounds",
        Stage::Stitch | Stage::Lift | Stage::Distances | Stage::Polish => "steps at most",
        Stage::Regions | Stage::Classical | Stage::Sensor => "steps",
    }
}

const NO_PANIC: &str = "nothing panics while progress is shown (bug in covimap)";

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().expect(NO_PANIC)
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use super::*;

    fn running(total: Option<u64>, done: u64) -> Running {
        Running { name: "local maps", unit: "regions", total, done, since: Instant::now() }
    }

    #[test]
    fn a_line_says_what_is_done_of_how_much() {
        assert_eq!(
            line(&running(Some(900), 312)),
            "covimap: local maps: 312 of 900 regions, 0 s, about 0 s left"
        );
        assert_eq!(line(&running(Some(900), 0)), "covimap: local maps: 0 of 900 regions, 0 s");
        assert_eq!(line(&running(None, 312)), "covimap: local maps: 312 regions, 0 s");
        assert_eq!(line(&running(None, 0)), "covimap: local maps: 0 s");
    }

    #[test]
    fn the_rest_goes_on_as_the_beginning_did() {
        // 30 s for a quarter: three times that for the other three.
        assert_eq!(remaining(Duration::from_secs(30), 2, 8), Some(Duration::from_secs(90)));
        assert_eq!(remaining(Duration::from_secs(30), 0, 8), None);
        // More was done than announced.
        assert_eq!(remaining(Duration::from_secs(30), 9, 8), Some(Duration::ZERO));
    }

    #[test]
    fn stages_are_timed_once_each_and_work_outside_of_one_is_ignored() {
        let progress = Progress::new(Console { quiet: true });
        progress.advanced(1);
        for stage in [Stage::Polish, Stage::Count, Stage::Polish] {
            progress.started(stage, Some(10));
            progress.advanced(4);
            assert_eq!(
                lock(&progress.state).running.map(|running| (running.name, running.done)),
                Some((name(stage), 4))
            );
            progress.finished(stage);
        }
        let stages: Vec<_> = progress.end().into_iter().map(|(stage, _)| stage).collect();
        assert_eq!(stages, [Stage::Count, Stage::Polish]);
    }

    #[test]
    fn a_ticker_ticks_until_it_is_dropped() {
        let (ticks, heard) = mpsc::channel();
        let ticker = Ticker::start(Duration::from_millis(1), move || ticks.send(()).unwrap());
        heard.recv().unwrap();
        heard.recv().unwrap();
        drop(ticker);
        // The sending end is gone with the thread, so this comes to an end.
        heard.iter().for_each(drop);
    }

    #[test]
    fn a_ticker_that_is_dropped_at_once_does_not_wait_for_its_tick() {
        let century = Duration::from_secs(100 * 365 * 86_400);
        drop(Ticker::start(century, || panic!("it is too early")));
    }
}
