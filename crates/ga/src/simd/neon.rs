//! The path of aarch64.

use super::lanes::Work;
use super::transpose::{self, squares};
use super::{Element, Lane};
use std::arch::aarch64::*;

#[target_feature(enable = "neon")]
pub(super) fn run<T: Work>(work: T) -> T::Output {
    work.run::<true>()
}

transpose::registers! {
    float64x2_t load_2 store_2 (p, x)
        f64 vld1q_f64(p), vst1q_f64(p, x);
        f32 vcvt_f64_f32(vld1_f32(p)), vst1_f32(p, vcvt_f32_f64(x));
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

/// Two rows of two numbers that begin `size` numbers apart, transposed.
///
/// # Safety
/// The numbers are within one object.
#[inline]
#[target_feature(enable = "neon")]
unsafe fn read_square<T: Element>(rows: *const T, size: usize) -> [float64x2_t; 2] {
    // SAFETY: as the caller promises.
    unsafe { transpose([T::load_2(rows), T::load_2(rows.add(size))]) }
}

/// Writes the columns of two rows of two numbers, which begin `size` numbers apart.
///
/// # Safety
/// There is room for the numbers.
#[inline]
#[target_feature(enable = "neon")]
unsafe fn write_square<T: Element>(columns: [float64x2_t; 2], rows: *mut T, size: usize) {
    let [first, second] = transpose(columns);
    // SAFETY: as the caller promises.
    unsafe {
        T::store_2(rows, first);
        T::store_2(rows.add(size), second);
    }
}

squares!("neon", 2, zero, load_2, store_2, read_square, write_square, gather, scatter);

/// A plain copy: there is no way past the caches.
#[target_feature(enable = "neon")]
pub(super) fn stream<T: Element>(from: &[T], to: &mut [T]) {
    to.copy_from_slice(from);
}
