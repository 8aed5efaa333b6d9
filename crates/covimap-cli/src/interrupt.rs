//! Ctrl-C: stop in good order where the work allows it, at once where it does not.

use std::process;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};

use anyhow::Context;

use crate::console::complain;
use crate::exit;

/// Whether somebody asked to stop.
static REQUESTED: AtomicBool = AtomicBool::new(false);
/// How many [`Deferral`]s are alive.
static DEFERRED: AtomicUsize = AtomicUsize::new(0);

/// Listens for Ctrl-C and for requests to terminate from now on.
///
/// # Errors
/// When the system refuses a signal handler.
pub fn listen() -> anyhow::Result<()> {
    ctrlc::set_handler(|| {
        if REQUESTED.swap(true, SeqCst) || DEFERRED.load(SeqCst) == 0 {
            complain("covimap: interrupted");
            process::exit(exit::INTERRUPTED.into());
        }
        complain("covimap: stopping; once more stops at once");
    })
    .context("cannot listen for Ctrl-C")
}

/// Whether Ctrl-C was pressed; work that asks this ends by itself.
pub fn requested() -> bool {
    REQUESTED.load(SeqCst)
}

/// While it lives, the first Ctrl-C only sets [`requested`]; a second one still ends the program.
#[derive(Debug)]
pub struct Deferral(());

impl Deferral {
    pub fn new() -> Self {
        DEFERRED.fetch_add(1, SeqCst);
        Self(())
    }
}

impl Drop for Deferral {
    fn drop(&mut self) {
        DEFERRED.fetch_sub(1, SeqCst);
    }
}
