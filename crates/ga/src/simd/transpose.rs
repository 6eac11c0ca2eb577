//! Conversion between rows and lanes by square transposes, for instruction sets of any width.

/// The trait of numbers that are registers of `f64` when read: for each width how `f64` and `f32` are loaded and stored,
/// as expressions of the pointer and the register.
macro_rules! registers {
    ($($register:ident $load:ident $store:ident ($p:ident, $x:ident)
        f64 $load_64:expr, $store_64:expr; f32 $load_32:expr, $store_32:expr;)*) => {
        /// Numbers of a row as registers of `f64`, and back.
        ///
        /// # Safety
        /// As many numbers as a register holds are within one object, and the machine has its instructions.
        pub trait Registers {
            $(
                #[doc(hidden)]
                unsafe fn $load(from: *const Self) -> $register;
                #[doc(hidden)]
                unsafe fn $store(to: *mut Self, x: $register);
            )*
        }

        impl Registers for f64 {
            $(transpose::registers!(@ $register $load $store ($p, $x) $load_64, $store_64);)*
        }

        impl Registers for f32 {
            $(transpose::registers!(@ $register $load $store ($p, $x) $load_32, $store_32);)*
        }
    };
    (@ $register:ident $load:ident $store:ident ($p:ident, $x:ident) $loaded:expr, $stored:expr) => {
        #[inline(always)]
        unsafe fn $load($p: *const Self) -> $register {
            // SAFETY: as the trait demands.
            unsafe { $loaded }
        }

        #[inline(always)]
        unsafe fn $store($p: *mut Self, $x: $register) {
            // SAFETY: as the trait demands.
            unsafe { $stored }
        }
    };
}

/// Rows to lanes and back by square transposes of `$n` rows by `$n` columns. The last square of a long row overlaps the
/// previous one. A short row is read or written with the beginning of the next one, which is overwritten later; so a
/// group is processed only if the next row exists. Both return the number of rows that they processed.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
macro_rules! squares {
    ($feature:tt, $n:literal, $zero:ident, $load:ident, $store:ident, $read:ident, $write:ident, $gather:ident, $scatter:ident) => {
        /// # Safety
        /// The numbers fit the lanes, which are at least one.
        #[target_feature(enable = $feature)]
        pub(in crate::simd) unsafe fn $gather<T: Element, const W: usize>(
            rows: &[T],
            lanes: &mut [Lane<W>],
        ) -> usize {
            let size = lanes.len();
            let last = size.saturating_sub($n);
            let mut done = 0;
            while (done + $n - 1) * size + last + $n <= rows.len() && done + $n <= W {
                for column in (0..size).step_by($n).map(|column| column.min(last)) {
                    // SAFETY: `$n` numbers from `(done + i) size + column` on are within the rows.
                    let square = unsafe { $read(rows.as_ptr().add(done * size + column), size) };
                    for k in 0..$n {
                        if k < size {
                            // SAFETY: `done + $n <= W`.
                            unsafe { f64::$store(lanes[column + k].0.as_mut_ptr().add(done), square[k]) };
                        }
                    }
                }
                done += $n;
            }
            done
        }

        /// # Safety
        /// The numbers fit the lanes, which are at least one.
        #[target_feature(enable = $feature)]
        pub(in crate::simd) unsafe fn $scatter<T: Element, const W: usize>(
            lanes: &[Lane<W>],
            rows: &mut [T],
        ) -> usize {
            let size = lanes.len();
            let last = size.saturating_sub($n);
            let mut done = 0;
            while (done + $n - 1) * size + last + $n <= rows.len() && done + $n <= W {
                for column in (0..size).step_by($n).map(|column| column.min(last)) {
                    let mut square = [$zero(); $n];
                    for k in 0..$n {
                        if k < size {
                            // SAFETY: `done + $n <= W`.
                            square[k] = unsafe { f64::$load(lanes[column + k].0.as_ptr().add(done)) };
                        }
                    }
                    // SAFETY: `$n` numbers from `(done + i) size + column` on are within the rows.
                    unsafe { $write(square, rows.as_mut_ptr().add(done * size + column), size) };
                }
                done += $n;
            }
            done
        }
    };
}

pub(super) use registers;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
pub(super) use squares;
