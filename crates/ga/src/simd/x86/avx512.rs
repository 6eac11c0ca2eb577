//! AVX-512.

use super::*;

run_and_stream!("avx512f,fma", 8, _mm512_loadu_pd, _mm512_stream_pd);
short!("avx512f,fma", 8, __m512d, _mm512_setzero_pd, _mm512_set1_pd, load_8, store_8);
squares!(
    "avx512f",
    8,
    _mm512_setzero_pd,
    load_8,
    store_8,
    read_square,
    write_square,
    gather_squares,
    scatter_squares
);

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
        // SAFETY: `8 SIZE` numbers from `8 SIZE group` on are within the rows.
        let columns = unsafe { read::<T, SIZE>(rows.as_ptr().add(group * SIZE * 8)) };
        for (lane, &x) in lanes.iter_mut().zip(&columns) {
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
        let mut columns = [_mm512_setzero_pd(); SIZE];
        for (x, lane) in columns.iter_mut().zip(lanes) {
            // SAFETY: `group < W / 8`, since the numbers fit the lanes.
            *x = unsafe { _mm512_loadu_pd(lane.0.as_ptr().add(group * 8)) };
        }
        // SAFETY: `8 SIZE` numbers from `8 SIZE group` on are within the rows.
        unsafe { write::<T, SIZE>(columns, rows.as_mut_ptr().add(group * SIZE * 8)) };
    }
    whole * 8
}

/// Writes eight rows of `SIZE` numbers by their columns.
///
/// # Safety
/// There is room for the numbers.
#[inline]
#[target_feature(enable = "avx512f")]
unsafe fn write<T: Element, const SIZE: usize>(columns: [__m512d; SIZE], rows: *mut T) {
    let registers = rows_of(columns);
    for r in 0..SIZE {
        // SAFETY: as the caller promises.
        unsafe { T::store_8(rows.add(r * 8), registers[r]) };
    }
}

/// Writes rows register by register. Past the caches it writes whole cache lines wherever the rows begin: a line is the end
/// of one register and the beginning of the next.
struct Writer<const STREAMED: bool> {
    /// The numbers of a register after the end of a line, which begin the next one.
    over: usize,
    /// The places of a line in two registers.
    places: __m512i,
    last: __m512d,
    begun: bool,
}

impl<const STREAMED: bool> Writer<STREAMED> {
    /// `None` for results that it cannot stream.
    #[target_feature(enable = "avx512f")]
    fn new<T: Element>(out: &[T]) -> Option<Self> {
        let over = (out.as_ptr().addr() / 8) % 8;
        let places = integers(&std::array::from_fn(|i| (8 - over + i) as i64));
        let writer = Writer { over, places, last: _mm512_setzero_pd(), begun: false };
        (!STREAMED || size_of::<T>() == 8).then_some(writer)
    }

    /// # Safety
    /// There is room for the register.
    #[inline]
    #[target_feature(enable = "avx512f")]
    unsafe fn write<T: Element>(&mut self, to: *mut T, register: __m512d) {
        // SAFETY: passed on; before `to` there is what was written last.
        unsafe {
            if STREAMED && self.begun {
                let line = _mm512_permutex2var_pd(self.last, self.places, register);
                _mm512_stream_pd(to.cast::<f64>().sub(self.over), line);
            } else {
                T::store_8(to, register);
            }
        }
        if STREAMED {
            (self.last, self.begun) = (register, true);
        }
    }

    /// Writes the beginning of the last line.
    ///
    /// # Safety
    /// `end` is the end of what was written.
    #[target_feature(enable = "avx512f")]
    unsafe fn finish<T: Element>(self, end: *mut T) {
        if STREAMED && self.begun {
            let rest = (1u8 << self.over) - 1;
            let line = _mm512_permutex2var_pd(self.last, self.places, self.last);
            // SAFETY: the numbers of the mask were written.
            unsafe { _mm512_mask_storeu_pd(end.cast::<f64>().sub(self.over), rest, line) };
            fence();
        }
    }
}

/// Eight integers of 64 bits.
#[inline]
#[target_feature(enable = "avx512f")]
fn integers(numbers: &[i64; 8]) -> __m512i {
    // SAFETY: eight integers of 64 bits.
    unsafe { _mm512_loadu_epi64(numbers.as_ptr()) }
}

#[inline]
#[target_feature(enable = "avx512f")]
fn columns<const SIZE: usize>(registers: [__m512d; SIZE]) -> [__m512d; SIZE] {
    let mut columns = registers;
    if SIZE == 4 {
        // Numbers 0 and 2, or 1 and 3, of rows 0 to 3, or 4 to 7.
        let (r, t) = (registers, &mut columns);
        let (a0, a1) = (_mm512_unpacklo_pd(r[0], r[1 % SIZE]), _mm512_unpackhi_pd(r[0], r[1 % SIZE]));
        let (b0, b1) =
            (_mm512_unpacklo_pd(r[2 % SIZE], r[3 % SIZE]), _mm512_unpackhi_pd(r[2 % SIZE], r[3 % SIZE]));
        let (even, odd) = (integers(&[0, 4, 1, 5, 8, 12, 9, 13]), integers(&[2, 6, 3, 7, 10, 14, 11, 15]));
        t[0] = _mm512_permutex2var_pd(a0, even, b0);
        t[1 % SIZE] = _mm512_permutex2var_pd(a1, even, b1);
        t[2 % SIZE] = _mm512_permutex2var_pd(a0, odd, b0);
        t[3 % SIZE] = _mm512_permutex2var_pd(a1, odd, b1);
    } else {
        columns = pick(registers, &Picks::<SIZE>::GATHER);
    }
    columns
}

#[inline]
#[target_feature(enable = "avx512f")]
fn rows_of<const SIZE: usize>(columns: [__m512d; SIZE]) -> [__m512d; SIZE] {
    let mut rows = columns;
    if SIZE == 4 {
        let (c, t) = (columns, &mut rows);
        let (low, high) = (integers(&[0, 2, 8, 10, 1, 3, 9, 11]), integers(&[4, 6, 12, 14, 5, 7, 13, 15]));
        let a0 = _mm512_permutex2var_pd(c[0], low, c[2 % SIZE]);
        let a1 = _mm512_permutex2var_pd(c[1 % SIZE], low, c[3 % SIZE]);
        let b0 = _mm512_permutex2var_pd(c[0], high, c[2 % SIZE]);
        let b1 = _mm512_permutex2var_pd(c[1 % SIZE], high, c[3 % SIZE]);
        t[0] = _mm512_unpacklo_pd(a0, a1);
        t[1 % SIZE] = _mm512_unpackhi_pd(a0, a1);
        t[2 % SIZE] = _mm512_unpacklo_pd(b0, b1);
        t[3 % SIZE] = _mm512_unpackhi_pd(b0, b1);
    } else {
        rows = pick(columns, &Picks::<SIZE>::SCATTER);
    }
    rows
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

/// Eight rows of eight numbers that begin `size` numbers apart, transposed: halves of two rows side by side, pairs of rows,
/// then of pairs. Reading halves saves the permutes of a last stage.
///
/// # Safety
/// The numbers are within one object.
#[inline]
#[target_feature(enable = "avx512f")]
unsafe fn read_square<T: Element>(rows: *const T, size: usize) -> [__m512d; 8] {
    let mut columns = [_mm512_setzero_pd(); 8];
    for half in 0..2 {
        let mut r = [_mm512_setzero_pd(); 4];
        for (place, i) in [0, 1, 4, 5].into_iter().enumerate() {
            // SAFETY: as the caller promises.
            unsafe {
                let (low, high) = (rows.add(i * size + 4 * half), rows.add((i + 2) * size + 4 * half));
                let low = _mm512_castpd256_pd512(T::load_4(low));
                r[place] = _mm512_insertf64x4::<1>(low, T::load_4(high));
            }
        }
        let (a0, a1) = (_mm512_unpacklo_pd(r[0], r[1]), _mm512_unpackhi_pd(r[0], r[1]));
        let (b0, b1) = (_mm512_unpacklo_pd(r[2], r[3]), _mm512_unpackhi_pd(r[2], r[3]));
        columns[4 * half] = _mm512_shuffle_f64x2::<0x88>(a0, b0);
        columns[4 * half + 1] = _mm512_shuffle_f64x2::<0x88>(a1, b1);
        columns[4 * half + 2] = _mm512_shuffle_f64x2::<0xdd>(a0, b0);
        columns[4 * half + 3] = _mm512_shuffle_f64x2::<0xdd>(a1, b1);
    }
    columns
}

/// Writes the columns of eight rows of eight numbers, which begin `size` numbers apart: pairs of columns, then of pairs, the
/// halves of two rows side by side.
///
/// # Safety
/// There is room for the numbers.
#[inline]
#[target_feature(enable = "avx512f")]
unsafe fn write_square<T: Element>(columns: [__m512d; 8], rows: *mut T, size: usize) {
    for half in 0..2 {
        let c = &columns[4 * half..4 * half + 4];
        // Two numbers of each even row, and of each odd one.
        let (a0, a1) = (_mm512_unpacklo_pd(c[0], c[1]), _mm512_unpackhi_pd(c[0], c[1]));
        let (b0, b1) = (_mm512_unpacklo_pd(c[2], c[3]), _mm512_unpackhi_pd(c[2], c[3]));
        let (low, high) = (integers(&[0, 1, 8, 9, 2, 3, 10, 11]), integers(&[4, 5, 12, 13, 6, 7, 14, 15]));
        for (odd, a, b) in [(0, a0, b0), (1, a1, b1)] {
            for (first, places) in [(odd, low), (odd + 4, high)] {
                let halves = _mm512_permutex2var_pd(a, places, b);
                // SAFETY: as the caller promises.
                unsafe {
                    T::store_4(rows.add(first * size + 4 * half), _mm512_castpd512_pd256(halves));
                    let next = rows.add((first + 2) * size + 4 * half);
                    T::store_4(next, _mm512_extractf64x4_pd::<1>(halves));
                }
            }
        }
    }
}
