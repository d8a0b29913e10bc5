//! The widest vectors that the processor has, chosen when the program runs.

use pulp::{Arch, Simd, WithSimd};

struct Work<F>(F);

impl<R, F: FnOnce() -> R> WithSimd for Work<F> {
    type Output = R;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> R {
        (self.0)()
    }
}

/// Does `work` compiled for the processor at hand. Only what is inlined into `work` is compiled so,
/// and `work` itself has to be: write `widest(#[inline(always)] || ...)`.
#[inline(always)]
pub(crate) fn widest<R>(work: impl FnOnce() -> R) -> R {
    Arch::new().dispatch(Work(work))
}
