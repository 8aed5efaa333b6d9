//! Arithmetic with the widest registers that the processor has.

/// Runs arithmetic with the widest registers that the processor has. Only what is inlined gains by it. No sum is put
/// into another order: results are the same on every processor.
#[inline]
pub(crate) fn wide<R>(arithmetic: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(arithmetic)
}
