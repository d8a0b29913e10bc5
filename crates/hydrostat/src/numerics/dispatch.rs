//! The widest vectors that the processor has, chosen when the program runs.

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
use pulp::{Arch, Simd, WithSimd};

/// Work that is compiled for more than one kind of processor.
pub(crate) trait Work {
    type Output;
    /// Does it; `FUSED` says whether multiply and add are one instruction. Has to be inlined.
    fn run<const FUSED: bool>(self) -> Self::Output;
}

struct Any<F>(F);

impl<R, F: FnOnce() -> R> Work for Any<F> {
    type Output = R;
    #[inline(always)]
    fn run<const FUSED: bool>(self) -> R {
        (self.0)()
    }
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
struct Dispatched<W>(W);

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
impl<W: Work> WithSimd for Dispatched<W> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> W::Output {
        // The vectors that are chosen between come with fused multiply-add.
        if S::IS_SCALAR { self.0.run::<false>() } else { self.0.run::<true>() }
    }
}

/// Does `work` compiled for the processor at hand. Only what is inlined into `work` is compiled so,
/// and `work` itself has to be: write `widest(#[inline(always)] || ...)`.
#[inline(always)]
pub(crate) fn widest<R>(work: impl FnOnce() -> R) -> R {
    dispatch(Any(work))
}

/// Does `block` in [`widest`] for every block of stations with its part of `out`, along the arm, until one fails.
/// `block` has to be an inlined closure, too.
#[inline(always)]
pub(crate) fn each_block<S, O, E>(
    stations: &mut [S],
    out: &mut [O],
    mut block: impl FnMut(usize, &mut S, &mut O) -> Result<(), E>,
) -> Result<(), E> {
    widest(
        #[inline(always)]
        || {
            for (index, (station, out)) in stations.iter_mut().zip(out).enumerate() {
                block(index, station, out)?;
            }
            Ok(())
        },
    )
}

/// [`widest`] for work that wants to know whether there is a fused multiply-add.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
#[inline(always)]
pub(crate) fn dispatch<W: Work>(work: W) -> W::Output {
    Arch::new().dispatch(Dispatched(work))
}

/// [`widest`] for work that wants to know whether there is a fused multiply-add. There is nothing to choose between on
/// this kind of processor, so that nothing is compiled twice.
#[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
#[inline(always)]
pub(crate) fn dispatch<W: Work>(work: W) -> W::Output {
    work.run::<{ cfg!(target_arch = "aarch64") }>()
}

struct Fused;

impl Work for Fused {
    type Output = bool;
    #[inline(always)]
    fn run<const FUSED: bool>(self) -> bool {
        FUSED
    }
}

/// Whether solves on this processor run on what is compiled for wide vectors with fused multiply-add (on x86: AVX2),
/// not on what is compiled for any processor; on 64-bit Arm always. Answers agree to the tolerance, not to the last
/// bit.
///
/// ```
/// println!("wide vectors: {}", hydrostat::has_wide_vectors());
/// ```
pub fn has_wide_vectors() -> bool {
    dispatch(Fused)
}
