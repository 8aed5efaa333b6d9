//! Arithmetic with the widest registers that the processor has.

/// Runs arithmetic with the widest registers that the processor has. Only what is inlined gains by it. No sum is put
/// into another order: results are the same on every processor.
///
/// # Examples
/// ```
/// let sums = covimap_embed::wide(|| [1.0, 2.0].map(|x| x + 0.5));
/// assert_eq!(sums, [1.5, 2.5]);
/// ```
#[inline]
pub fn wide<R>(arithmetic: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(arithmetic)
}
