//! The path of aarch64. `gather` and `scatter` return the number of rows they processed; the caller does the rest.

use super::lanes::Work;
use super::squares::squares;
use super::{Element, Kernel, Lane};
use std::arch::aarch64::*;

#[target_feature(enable = "neon")]
pub(super) fn apply_neon<const W: usize, K: Kernel<W>>(
    kernel: &K,
    a: &[Lane<W>],
    b: &[Lane<W>],
    out: &mut [Lane<W>],
) {
    kernel.fused_block(a, b, out);
}

#[target_feature(enable = "neon")]
pub(super) fn run_neon<T: Work>(work: T) -> T::Output {
    work.run::<true>()
}

/// Hardware prefetching suffices.
#[inline(always)]
fn prefetch_ahead<T>(_: *const T) {}

/// Numbers of a row as registers of `f64`, and back.
///
/// # Safety
/// As many numbers as a register holds are within one object, and the machine has its instructions.
pub trait Registers {
    /// Two numbers.
    #[doc(hidden)]
    unsafe fn load_2(from: *const Self) -> float64x2_t;
    #[doc(hidden)]
    unsafe fn store_2(to: *mut Self, x: float64x2_t);
}

impl Registers for f64 {
    #[inline(always)]
    unsafe fn load_2(from: *const f64) -> float64x2_t {
        // SAFETY: as the trait demands.
        unsafe { vld1q_f64(from) }
    }

    #[inline(always)]
    unsafe fn store_2(to: *mut f64, x: float64x2_t) {
        // SAFETY: as the trait demands.
        unsafe { vst1q_f64(to, x) }
    }
}

impl Registers for f32 {
    #[inline(always)]
    unsafe fn load_2(from: *const f32) -> float64x2_t {
        // SAFETY: as the trait demands.
        unsafe { vcvt_f64_f32(vld1_f32(from)) }
    }

    #[inline(always)]
    unsafe fn store_2(to: *mut f32, x: float64x2_t) {
        // SAFETY: as the trait demands.
        unsafe { vst1_f32(to, vcvt_f32_f64(x)) }
    }
}

#[inline]
#[target_feature(enable = "neon")]
fn zero() -> float64x2_t {
    vdupq_n_f64(0.0)
}

/// Two rows of two numbers, transposed.
#[inline]
#[target_feature(enable = "neon")]
fn transpose([r0, r1]: [float64x2_t; 2]) -> [float64x2_t; 2] {
    [vtrn1q_f64(r0, r1), vtrn2q_f64(r0, r1)]
}

squares!("neon", 2, zero, load_2, store_2, transpose, gather_neon, scatter_neon);
