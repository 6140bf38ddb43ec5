//! Ctrl-C: the first one ends a solve with its best state, the second one ends the program.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, LazyLock};

use dpana::alternation::Interrupt;
use signal_hook::consts::SIGINT;
use signal_hook::flag;

static RAISED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// What a shell calls a program that was ended by Ctrl-C.
const ENDED: i32 = 130;

/// A flag that Ctrl-C raises from here on; none where the system lets nobody listen, and Ctrl-C ends the program.
pub(super) fn on_ctrl_c() -> Option<Interrupt> {
    // In this order: the first one finds the flag still down.
    flag::register_conditional_shutdown(SIGINT, ENDED, Arc::clone(&RAISED)).ok()?;
    flag::register(SIGINT, Arc::clone(&RAISED)).ok()?;
    Some(Interrupt::new(&RAISED))
}
