//! How a build goes on: bars on a terminal, a plain line now and then elsewhere.

use std::io::{self, IsTerminal, Write};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use covimap_map::{Observer, Stage};
use indicatif::{ProgressBar, ProgressStyle};

use crate::console::Console;
use crate::interrupt::{self, Deferral};

/// Between two plain lines about the same stage; short enough for watchdogs that end silent jobs.
const PLAIN_EVERY: Duration = Duration::from_secs(10);
/// Between two turns of the spinner.
const SPIN_EVERY: Duration = Duration::from_millis(120);

/// Watches a build for the person who started it, and stops it on Ctrl-C.
pub struct Progress {
    bars: bool,
    state: Arc<Mutex<State>>,
    plain: Option<PlainLines>,
    _deferral: Deferral,
}

#[derive(Default)]
struct State {
    running: Option<Running>,
    times: Vec<(Stage, Duration)>,
}

struct Running {
    stage: Stage,
    total: Option<u64>,
    done: u64,
    since: Instant,
    bar: ProgressBar,
}

impl Progress {
    /// Bars if standard error is a terminal, else plain lines; nothing if the console is quiet.
    pub fn new(console: Console) -> Self {
        let terminal = io::stderr().is_terminal();
        let state = Arc::<Mutex<State>>::default();
        let plain = (!console.quiet && !terminal)
            .then(|| PlainLines::start(state.clone(), PLAIN_EVERY, io::stderr()));
        Self { bars: !console.quiet && terminal, state, plain, _deferral: Deferral::new() }
    }

    /// Ends the display and returns the time that each stage took, in order.
    pub fn end(self) -> Vec<(Stage, Duration)> {
        drop(self.plain);
        std::mem::take(&mut lock(&self.state).times)
    }

    fn bar(&self, stage: Stage, total: Option<u64>) -> ProgressBar {
        if !self.bars {
            return ProgressBar::hidden();
        }
        let (bar, template) = match total {
            Some(total) if stage == Stage::Read => {
                (ProgressBar::new(total), "{msg:<12} {bar:32} {bytes}/{total_bytes}, {eta} left")
            }
            Some(total) => {
                (ProgressBar::new(total), "{msg:<12} {bar:32} {human_pos}/{human_len}, {eta} left")
            }
            None => (ProgressBar::new_spinner(), "{msg:<12} {spinner} {elapsed}"),
        };
        bar.set_style(ProgressStyle::with_template(template).expect("templates are valid (bug in covimap)"));
        bar.set_message(name(stage));
        bar.enable_steady_tick(SPIN_EVERY);
        bar
    }
}

impl Observer for Progress {
    fn started(&self, stage: Stage, total: Option<u64>) {
        let bar = self.bar(stage, total);
        lock(&self.state).running = Some(Running { stage, total, done: 0, since: Instant::now(), bar });
    }

    fn advanced(&self, amount: u64) {
        if let Some(running) = &mut lock(&self.state).running {
            running.done += amount;
            running.bar.set_position(running.done);
        }
    }

    fn finished(&self, stage: Stage) {
        let mut state = lock(&self.state);
        if let Some(running) = state.running.take() {
            running.bar.finish_and_clear();
            state.times.push((stage, running.since.elapsed()));
        }
    }

    fn interrupted(&self) -> bool {
        interrupt::requested()
    }
}

impl Drop for Running {
    /// A stage that an error ended leaves no bar behind.
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A thread that says now and then what goes on, until it is dropped.
struct PlainLines {
    ended: Arc<(Mutex<bool>, Condvar)>,
    thread: Option<JoinHandle<()>>,
}

impl PlainLines {
    fn start(state: Arc<Mutex<State>>, every: Duration, mut to: impl Write + Send + 'static) -> Self {
        let ended = Arc::<(Mutex<bool>, Condvar)>::default();
        let watched = ended.clone();
        let thread = thread::spawn(move || {
            let (end, changed) = &*watched;
            let mut end = lock(end);
            while !*end {
                end = changed.wait_timeout(end, every).expect("no panic under this lock (bug in covimap)").0;
                let line = lock(&state)
                    .running
                    .as_ref()
                    .filter(|running| running.since.elapsed() >= every)
                    .map(line);
                if let (false, Some(line)) = (*end, line) {
                    let _ = writeln!(to, "{line}");
                }
            }
        });
        Self { ended, thread: Some(thread) }
    }
}

impl Drop for PlainLines {
    fn drop(&mut self) {
        *lock(&self.ended.0) = true;
        self.ended.1.notify_all();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn line(running: &Running) -> String {
    let (name, done, seconds) = (name(running.stage), running.done, running.since.elapsed().as_secs());
    match running.total {
        Some(total) => format!("covimap: {name}: {done} of {total} {}, {seconds} s", unit(running.stage)),
        None => format!("covimap: {name}: {seconds} s"),
    }
}

/// What people call a stage.
pub fn name(stage: Stage) -> &'static str {
    match stage {
        Stage::Read => "read",
        Stage::Count => "count",
        Stage::Regions => "regions",
        Stage::LocalMaps => "local maps",
        Stage::Stitch => "stitch",
        Stage::Polish => "polish",
        Stage::Classical => "classical",
    }
}

fn unit(stage: Stage) -> &'static str {
    match stage {
        Stage::Read => "bytes",
        Stage::Count => "landmarks",
        Stage::Regions | Stage::LocalMaps => "regions",
        Stage::Stitch | Stage::Polish | Stage::Classical => "steps",
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().expect("no panic under this lock (bug in covimap)")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn running(total: Option<u64>) -> Running {
        Running {
            stage: Stage::LocalMaps,
            total,
            done: 312,
            since: Instant::now(),
            bar: ProgressBar::hidden(),
        }
    }

    #[test]
    fn a_line_says_what_is_done_of_how_much() {
        assert_eq!(line(&running(Some(900))), "covimap: local maps: 312 of 900 regions, 0 s");
        assert_eq!(line(&running(None)), "covimap: local maps: 0 s");
    }

    #[test]
    fn stages_are_timed_in_order_and_work_outside_of_one_is_ignored() {
        let progress = Progress::new(Console { quiet: true });
        progress.advanced(1);
        for stage in [Stage::Read, Stage::Count] {
            progress.started(stage, Some(10));
            progress.advanced(4);
            assert_eq!(lock(&progress.state).running.as_ref().map(|running| running.done), Some(4));
            progress.finished(stage);
        }
        let stages: Vec<_> = progress.end().into_iter().map(|(stage, _)| stage).collect();
        assert_eq!(stages, [Stage::Read, Stage::Count]);
    }

    #[test]
    fn a_long_stage_is_spoken_of_and_silence_follows_its_end() {
        let state = Arc::new(Mutex::new(State { running: Some(running(None)), times: Vec::new() }));
        let (said, heard) = io::pipe().unwrap();
        let lines = PlainLines::start(state, Duration::from_millis(1), said);
        let mut heard = io::BufReader::new(heard);
        let mut first = String::new();
        io::BufRead::read_line(&mut heard, &mut first).unwrap();
        assert_eq!(first, "covimap: local maps: 0 s\n");
        drop(lines);
        // The writing end closes with the thread: were it still alive, this would not return.
        io::Read::read_to_string(&mut heard, &mut String::new()).unwrap();
    }
}
