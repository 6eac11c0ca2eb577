//! The paths of x86-64.

use super::lanes::Work;
use super::map::{self, Map};
use super::short::{GROUP, Link, Numbers, Short};
use super::transpose::{self, squares};
use super::{Element, Lane};
use std::arch::x86_64::*;

mod short;

use short::short;

/// A cache line. A local one aligns the stack frame to cache lines, so that no spilled register spans two.
#[derive(Default)]
#[repr(align(64))]
struct Line {
    _numbers: [f64; 8],
}

/// The short method of a map for one row, whose numbers are the first of these.
#[target_feature(enable = "fma")]
#[expect(clippy::too_many_arguments)]
pub fn alone<M: Map<A, B, OUT>, const A: usize, const B: usize, const OUT: usize>(
    map: &M,
    x0: f64,
    x1: f64,
    x2: f64,
    x3: f64,
    x4: f64,
    x5: f64,
    x6: f64,
    x7: f64,
) -> [f64; OUT] {
    const { assert!(A + B <= 8, "a row has at most eight numbers") };
    let x = [x0, x1, x2, x3, x4, x5, x6, x7];
    let (mut a, mut b) = ([0.0; A], [0.0; B]);
    a.copy_from_slice(&x[..A]);
    b.copy_from_slice(&x[A..A + B]);
    map::alone(map.short::<1, true>(map::lanes_of_one(&a), map::lanes_of_one(&b)))
}

/// Does work with instructions of `$feature`, and copies past the caches by registers of `$width` numbers.
macro_rules! run_and_stream {
    ($feature:literal, $width:literal, $load:ident, $stream:ident) => {
        #[target_feature(enable = $feature)]
        pub fn run<T: Work>(work: T) -> T::Output {
            std::hint::black_box(&mut Line::default());
            work.run::<true>()
        }

        /// # Safety
        /// The slices have one length, whole cache lines, and `to` begins at one.
        #[target_feature(enable = $feature)]
        pub unsafe fn stream<T: Element>(from: &[T], to: &mut [T]) {
            let bytes = size_of_val(to);
            let (from, to) = (from.as_ptr().cast::<f64>(), to.as_mut_ptr().cast::<f64>());
            for i in (0..bytes / 8).step_by($width) {
                // SAFETY: a register from `8 i` on is within both, and aligned in `to`.
                unsafe { $stream(to.add(i), $load(from.add(i))) };
            }
        }
    };
}

/// Prefetches a cache line.
#[inline(always)]
pub(super) fn prefetch<T>(at: *const T) {
    // SAFETY: a hint; it reads nothing, so that the address may be any.
    unsafe { _mm_prefetch::<_MM_HINT_T0>(at.cast()) };
}

transpose::registers! {
    __m256d load_4 store_4 (p, x)
        f64 _mm256_loadu_pd(p), _mm256_storeu_pd(p, x);
        f32 _mm256_cvtps_pd(_mm_loadu_ps(p)), _mm_storeu_ps(p, _mm256_cvtpd_ps(x));
    __m512d load_8 store_8 (p, x)
        f64 _mm512_loadu_pd(p), _mm512_storeu_pd(p, x);
        f32 _mm512_cvtps_pd(_mm256_loadu_ps(p)), _mm256_storeu_ps(p, _mm512_cvtpd_ps(x));
}

pub(super) fn fence() {
    // SAFETY: every x86-64 machine has the instruction.
    unsafe { _mm_sfence() };
}

pub(super) mod avx512;

pub(super) mod avx2 {
    use super::*;

    run_and_stream!("avx2,fma", 4, _mm256_loadu_pd, _mm256_stream_pd);
    squares!("avx2", 4, _mm256_setzero_pd, load_4, store_4, read_square, write_square, gather, scatter);

    short!("avx2,fma", 4, __m256d, _mm256_setzero_pd, _mm256_set1_pd, load_4, store_4);

    /// Writes rows register by register; past the caches only [`super::super::traverse`] does.
    struct Writer<const STREAMED: bool>;

    impl<const STREAMED: bool> Writer<STREAMED> {
        fn new<T>(_: &[T]) -> Option<Self> {
            (!STREAMED).then_some(Writer)
        }

        /// # Safety
        /// There is room for the register.
        #[inline]
        #[target_feature(enable = "avx2")]
        unsafe fn write<T: Element>(&mut self, to: *mut T, register: __m256d) {
            // SAFETY: passed on.
            unsafe { T::store_4(to, register) };
        }

        /// # Safety
        /// `end` is the end of what was written.
        unsafe fn finish<T: Element>(self, _: *mut T) {}
    }

    /// Four rows of `SIZE` numbers, 1, 3 or 4, fill `SIZE` registers without gaps. Of three, the numbers of a column have
    /// different places: they are blended into one register and permuted.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn columns<const SIZE: usize>(registers: [__m256d; SIZE]) -> [__m256d; SIZE] {
        let mut columns = registers;
        match *columns.as_mut_slice() {
            [ref mut r0, ref mut r1, ref mut r2] => {
                let (x, y, z) = (*r0, *r1, *r2);
                *r0 = _mm256_permute4x64_pd::<0x6c>(_mm256_blend_pd::<0b0010>(
                    _mm256_blend_pd::<0b0100>(x, y),
                    z,
                ));
                *r1 = _mm256_permute4x64_pd::<0xb1>(_mm256_blend_pd::<0b0100>(
                    _mm256_blend_pd::<0b1001>(x, y),
                    z,
                ));
                *r2 = _mm256_permute4x64_pd::<0xc6>(_mm256_blend_pd::<0b1001>(
                    _mm256_blend_pd::<0b0010>(x, y),
                    z,
                ));
            }
            [ref mut r0, ref mut r1, ref mut r2, ref mut r3] => {
                [*r0, *r1, *r2, *r3] = transpose([*r0, *r1, *r2, *r3]);
            }
            [_] => {}
            _ => unreachable!("rows of one, three or four numbers"),
        }
        columns
    }

    /// The inverse of [`columns`].
    #[inline]
    #[target_feature(enable = "avx2")]
    fn rows_of<const SIZE: usize>(columns: [__m256d; SIZE]) -> [__m256d; SIZE] {
        let mut rows = columns;
        match *rows.as_mut_slice() {
            [ref mut c0, ref mut c1, ref mut c2] => {
                let x = _mm256_permute4x64_pd::<0x6c>(*c0);
                let y = _mm256_permute4x64_pd::<0xb1>(*c1);
                let z = _mm256_permute4x64_pd::<0xc6>(*c2);
                *c0 = _mm256_blend_pd::<0b0100>(_mm256_blend_pd::<0b0010>(x, y), z);
                *c1 = _mm256_blend_pd::<0b0010>(_mm256_blend_pd::<0b1001>(x, y), z);
                *c2 = _mm256_blend_pd::<0b1001>(_mm256_blend_pd::<0b0100>(x, y), z);
            }
            [ref mut c0, ref mut c1, ref mut c2, ref mut c3] => {
                [*c0, *c1, *c2, *c3] = transpose([*c0, *c1, *c2, *c3]);
            }
            [_] => {}
            _ => unreachable!("rows of one, three or four numbers"),
        }
        rows
    }

    /// Four rows of four numbers that begin `size` numbers apart, transposed.
    ///
    /// # Safety
    /// The numbers are within one object.
    #[inline]
    #[target_feature(enable = "avx2")]
    unsafe fn read_square<T: Element>(rows: *const T, size: usize) -> [__m256d; 4] {
        let mut square = [_mm256_setzero_pd(); 4];
        for i in 0..4 {
            // SAFETY: as the caller promises.
            square[i] = unsafe { T::load_4(rows.add(i * size)) };
        }
        transpose(square)
    }

    /// Writes the columns of four rows of four numbers, which begin `size` numbers apart.
    ///
    /// # Safety
    /// There is room for the numbers.
    #[inline]
    #[target_feature(enable = "avx2")]
    unsafe fn write_square<T: Element>(columns: [__m256d; 4], rows: *mut T, size: usize) {
        for (i, row) in transpose(columns).into_iter().enumerate() {
            // SAFETY: as the caller promises.
            unsafe { T::store_4(rows.add(i * size), row) };
        }
    }

    /// Four rows of four numbers, transposed: pairs of rows, then of pairs.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn transpose([r0, r1, r2, r3]: [__m256d; 4]) -> [__m256d; 4] {
        let (a0, a1) = (_mm256_unpacklo_pd(r0, r1), _mm256_unpackhi_pd(r0, r1));
        let (b0, b1) = (_mm256_unpacklo_pd(r2, r3), _mm256_unpackhi_pd(r2, r3));
        [
            _mm256_permute2f128_pd::<0x20>(a0, b0),
            _mm256_permute2f128_pd::<0x20>(a1, b1),
            _mm256_permute2f128_pd::<0x31>(a0, b0),
            _mm256_permute2f128_pd::<0x31>(a1, b1),
        ]
    }
}
