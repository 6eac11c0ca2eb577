//! The paths of x86-64.

use super::lanes::Work;
use super::squares::{self, squares};
use super::{Element, Lane};
use std::arch::x86_64::*;

/// A cache line. A local one aligns the stack frame to cache lines, so that no spilled register spans two.
#[derive(Default)]
#[repr(align(64))]
struct Line {
    _numbers: [f64; 8],
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

/// Prefetches the cache line 4 KiB ahead: beyond the end of a page, where hardware prefetching stops.
#[inline(always)]
fn prefetch_ahead<T>(from: *const T) {
    prefetch(from.wrapping_byte_add(4096));
}

/// Prefetches a cache line.
#[inline(always)]
pub(super) fn prefetch<T>(at: *const T) {
    // SAFETY: a hint; it reads nothing, so that the address may be any.
    unsafe { _mm_prefetch::<_MM_HINT_T0>(at.cast()) };
}

squares::registers! {
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

pub(super) mod avx2 {
    use super::*;

    run_and_stream!("avx2,fma", 4, _mm256_loadu_pd, _mm256_stream_pd);
    squares!("avx2", 4, _mm256_setzero_pd, load_4, store_4, transpose, gather, scatter);

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

pub(super) mod avx512 {
    use super::*;

    run_and_stream!("avx512f,fma", 8, _mm512_loadu_pd, _mm512_stream_pd);
    squares!("avx512f", 8, _mm512_setzero_pd, load_8, store_8, transpose, gather_squares, scatter_squares);

    /// Calls a function of the constant number of lanes below eight, or the other one.
    macro_rules! by_size {
        ($size:expr, $few:ident, $many:ident, $arguments:tt) => {
            match $size {
                1 => $few::<T, W, 1> $arguments,
                2 => $few::<T, W, 2> $arguments,
                3 => $few::<T, W, 3> $arguments,
                4 => $few::<T, W, 4> $arguments,
                5 => $few::<T, W, 5> $arguments,
                6 => $few::<T, W, 6> $arguments,
                7 => $few::<T, W, 7> $arguments,
                _ => $many $arguments,
            }
        };
    }

    /// # Safety
    /// The numbers fit the lanes, which are at least one.
    #[target_feature(enable = "avx512f")]
    pub unsafe fn gather<T: Element, const W: usize>(rows: &[T], lanes: &mut [Lane<W>]) -> usize {
        // SAFETY: passed on.
        unsafe { by_size!(lanes.len(), gather_few, gather_squares, (rows, lanes)) }
    }

    /// # Safety
    /// The numbers fit the lanes, which are at least one.
    #[target_feature(enable = "avx512f")]
    pub unsafe fn scatter<T: Element, const W: usize>(lanes: &[Lane<W>], rows: &mut [T]) -> usize {
        // SAFETY: passed on.
        unsafe { by_size!(lanes.len(), scatter_few, scatter_squares, (lanes, rows)) }
    }

    /// Eight rows of `SIZE` numbers fill `SIZE` registers without gaps: number `k` of row `i` is number
    /// `i SIZE + k` of them all.
    ///
    /// # Safety
    /// The numbers fit the `SIZE` lanes.
    #[target_feature(enable = "avx512f")]
    unsafe fn gather_few<T: Element, const W: usize, const SIZE: usize>(
        rows: &[T],
        lanes: &mut [Lane<W>],
    ) -> usize {
        let whole = rows.len() / (8 * SIZE);
        for group in 0..whole {
            let mut registers = [_mm512_setzero_pd(); SIZE];
            for r in 0..SIZE {
                // SAFETY: `8 SIZE` numbers from `8 SIZE group` on are within the rows.
                unsafe {
                    let from = rows.as_ptr().add((group * SIZE + r) * 8);
                    prefetch_ahead(from);
                    registers[r] = T::load_8(from);
                }
            }
            for (lane, &x) in lanes.iter_mut().zip(&pick(registers, &Picks::<SIZE>::GATHER)) {
                // SAFETY: `group < W / 8`, since the numbers fit the lanes.
                unsafe { _mm512_storeu_pd(lane.0.as_mut_ptr().add(group * 8), x) };
            }
        }
        whole * 8
    }

    /// The inverse of [`gather_few`].
    ///
    /// # Safety
    /// The numbers fit the `SIZE` lanes.
    #[target_feature(enable = "avx512f")]
    unsafe fn scatter_few<T: Element, const W: usize, const SIZE: usize>(
        lanes: &[Lane<W>],
        rows: &mut [T],
    ) -> usize {
        let whole = rows.len() / (8 * SIZE);
        for group in 0..whole {
            let mut registers = [_mm512_setzero_pd(); SIZE];
            for (x, lane) in registers.iter_mut().zip(lanes) {
                // SAFETY: `group < W / 8`, since the numbers fit the lanes.
                *x = unsafe { _mm512_loadu_pd(lane.0.as_ptr().add(group * 8)) };
            }
            let registers = pick(registers, &Picks::<SIZE>::SCATTER);
            for r in 0..SIZE {
                // SAFETY: `8 SIZE` numbers from `8 SIZE group` on are within the rows.
                unsafe { T::store_8(rows.as_mut_ptr().add((group * SIZE + r) * 8), registers[r]) };
            }
        }
        whole * 8
    }

    /// Indices of the permutes that pick each result register from `SIZE` sources, one source at a time. For source `s`,
    /// index `i` is `8 + at` if number `i` of the result is number `at` of `s`, and otherwise keeps the number. The first
    /// permute combines sources 0 and 1.
    type Indices<const SIZE: usize> = [[[i64; 8]; SIZE]; SIZE];

    struct Picks<const SIZE: usize>;

    impl<const SIZE: usize> Picks<SIZE> {
        /// Number `i` of lane `k` is number `i SIZE + k` of the registers.
        const GATHER: Indices<SIZE> = picks(true);

        /// Number `i SIZE + k` of the registers is number `i` of lane `k`.
        const SCATTER: Indices<SIZE> = picks(false);
    }

    const fn picks<const SIZE: usize>(gather: bool) -> Indices<SIZE> {
        let mut indices = [[[0; 8]; SIZE]; SIZE];
        let mut n = 0;
        while n < 8 * SIZE {
            let (i, k) = (n / SIZE, n % SIZE);
            if gather {
                set(&mut indices[k], i, n / 8, n % 8);
            } else {
                set(&mut indices[n / 8], n % 8, k, i);
            }
            n += 1;
        }
        indices
    }

    /// Number `i` of the result is number `at` of the source `from`.
    const fn set<const SIZE: usize>(indices: &mut [[i64; 8]; SIZE], i: usize, from: usize, at: usize) {
        let mut source = 1;
        while source < SIZE {
            indices[source][i] = if source == from {
                8 + at as i64
            } else if source == 1 && from == 0 {
                at as i64
            } else {
                i as i64
            };
            source += 1;
        }
    }

    #[inline]
    #[target_feature(enable = "avx512f")]
    fn pick<const SIZE: usize>(sources: [__m512d; SIZE], indices: &Indices<SIZE>) -> [__m512d; SIZE] {
        let mut picked = [sources[0]; SIZE];
        for r in 0..SIZE {
            for s in 1..SIZE {
                // SAFETY: eight integers of 64 bits.
                let index = unsafe { _mm512_loadu_epi64(indices[r][s].as_ptr()) };
                picked[r] = _mm512_permutex2var_pd(picked[r], index, sources[s]);
            }
        }
        picked
    }

    /// Eight rows of eight numbers, transposed: pairs of rows, then of pairs, then of fours.
    #[inline]
    #[target_feature(enable = "avx512f")]
    fn transpose([r0, r1, r2, r3, r4, r5, r6, r7]: [__m512d; 8]) -> [__m512d; 8] {
        let (a0, a1) = (_mm512_unpacklo_pd(r0, r1), _mm512_unpackhi_pd(r0, r1));
        let (b0, b1) = (_mm512_unpacklo_pd(r2, r3), _mm512_unpackhi_pd(r2, r3));
        let (c0, c1) = (_mm512_unpacklo_pd(r4, r5), _mm512_unpackhi_pd(r4, r5));
        let (d0, d1) = (_mm512_unpacklo_pd(r6, r7), _mm512_unpackhi_pd(r6, r7));
        // Each of a0 … d1 holds four columns of two rows, two numbers side by side; 0x88 takes the first
        // and third of both, 0xdd the second and fourth.
        let (p0, p2) = (_mm512_shuffle_f64x2::<0x88>(a0, b0), _mm512_shuffle_f64x2::<0xdd>(a0, b0));
        let (p1, p3) = (_mm512_shuffle_f64x2::<0x88>(a1, b1), _mm512_shuffle_f64x2::<0xdd>(a1, b1));
        let (q0, q2) = (_mm512_shuffle_f64x2::<0x88>(c0, d0), _mm512_shuffle_f64x2::<0xdd>(c0, d0));
        let (q1, q3) = (_mm512_shuffle_f64x2::<0x88>(c1, d1), _mm512_shuffle_f64x2::<0xdd>(c1, d1));
        [
            _mm512_shuffle_f64x2::<0x88>(p0, q0),
            _mm512_shuffle_f64x2::<0x88>(p1, q1),
            _mm512_shuffle_f64x2::<0x88>(p2, q2),
            _mm512_shuffle_f64x2::<0x88>(p3, q3),
            _mm512_shuffle_f64x2::<0xdd>(p0, q0),
            _mm512_shuffle_f64x2::<0xdd>(p1, q1),
            _mm512_shuffle_f64x2::<0xdd>(p2, q2),
            _mm512_shuffle_f64x2::<0xdd>(p3, q3),
        ]
    }
}
