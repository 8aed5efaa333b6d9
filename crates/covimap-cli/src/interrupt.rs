//! Ctrl-C: stop in good order where the work allows it, at once where it does not.

use std::process;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};
use std::thread;
use std::time::Duration;

use anyhow::Context;

use crate::console::complain;
use crate::exit;

/// Whether somebody asked to stop.
static REQUESTED: AtomicBool = AtomicBool::new(false);
/// Pieces of work that end by themselves when [`requested`].
static WORKING: AtomicUsize = AtomicUsize::new(0);
/// Files that are being written.
static WRITING: AtomicUsize = AtomicUsize::new(0);

/// Longest wait for work to end by itself: one factorisation of a large matrix takes longer, and reading may
/// wait for ever.
const PATIENCE: Duration = Duration::from_secs(2);
/// Between two looks at whether files are being written.
const LOOK_EVERY: Duration = Duration::from_millis(10);

/// Listens for Ctrl-C and for requests to terminate from now on.
///
/// # Errors
/// When the system refuses a signal handler.
pub fn listen() -> anyhow::Result<()> {
    ctrlc::set_handler(|| {
        if REQUESTED.swap(true, SeqCst) || (WORKING.load(SeqCst) == 0 && WRITING.load(SeqCst) == 0) {
            end();
        }
        complain("covimap: stopping; once more stops at once");
        // In a thread of its own, so that the next Ctrl-C is heard.
        thread::spawn(|| {
            thread::sleep(PATIENCE);
            while WRITING.load(SeqCst) > 0 {
                thread::sleep(LOOK_EVERY);
            }
            end();
        });
    })
    .context("cannot listen for Ctrl-C")
}

fn end() -> ! {
    complain("covimap: interrupted");
    process::exit(exit::INTERRUPTED.into())
}

/// Whether Ctrl-C was pressed; work that asks this ends by itself.
pub fn requested() -> bool {
    REQUESTED.load(SeqCst)
}

/// While it lives, the first Ctrl-C sets [`requested`] and leaves the work some time to end; a second one still
/// ends the program.
#[derive(Debug)]
pub struct Deferral(&'static AtomicUsize);

impl Deferral {
    /// For work that looks at [`requested`] now and then: it has [`PATIENCE`] to end.
    pub fn of_work() -> Self {
        Self::counted_in(&WORKING)
    }

    /// For writing a file: it is brought to its end.
    pub fn of_writing() -> Self {
        Self::counted_in(&WRITING)
    }

    fn counted_in(count: &'static AtomicUsize) -> Self {
        count.fetch_add(1, SeqCst);
        Self(count)
    }
}

impl Drop for Deferral {
    fn drop(&mut self) {
        self.0.fetch_sub(1, SeqCst);
    }
}
