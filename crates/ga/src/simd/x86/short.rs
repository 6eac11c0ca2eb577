//! Functions of short rows in registers, written once for registers of any width.

/// `Short` functions by groups of `$width` rows, read and written by `columns` and `rows_of` of the module.
macro_rules! short {
    ($feature:literal, $width:literal, $register:ty, $zero:ident, $all:ident, $load:ident, $store:ident) => {
        /// The columns of `$width` rows of `SIZE` numbers.
        ///
        /// # Safety
        /// The numbers are within one object.
        #[inline]
        #[target_feature(enable = $feature)]
        unsafe fn read<T: Element, const SIZE: usize>(rows: *const T) -> [$register; SIZE] {
            let mut registers = [$zero(); SIZE];
            for r in 0..SIZE {
                // SAFETY: as the caller promises.
                registers[r] = unsafe { T::$load(rows.add(r * $width)) };
            }
            columns(registers)
        }

        /// One row for all, as columns.
        #[target_feature(enable = $feature)]
        fn filled<T: Element, const SIZE: usize>(row: &[T]) -> [$register; SIZE] {
            let mut columns = [$zero(); SIZE];
            for (column, &x) in columns.iter_mut().zip(row) {
                *column = $all(x.into());
            }
            columns
        }

        /// Columns `$width number` and later of a block.
        ///
        /// # Safety
        /// The numbers are those of a block, rows of `SIZE` numbers or `SIZE` lanes, which has these columns.
        #[inline]
        #[target_feature(enable = $feature)]
        unsafe fn columns_of<T: Element, const SIZE: usize, const W: usize>(
            numbers: Numbers<T, W>,
            number: usize,
        ) -> [$register; SIZE] {
            match numbers {
                // SAFETY: as the caller promises.
                Numbers::Rows(rows) => unsafe { read(rows.as_ptr().add($width * SIZE * number)) },
                Numbers::Lanes(lanes) => {
                    let mut columns = [$zero(); SIZE];
                    for k in 0..SIZE {
                        // SAFETY: as the caller promises.
                        columns[k] = unsafe { f64::$load(lanes[k].0.as_ptr().add($width * number)) };
                    }
                    columns
                }
            }
        }

        /// Applies a function to a block.
        ///
        /// # Safety
        /// `a` and `b` are rows of `A` and `B` numbers or as many lanes, and there are `OUT` lanes for the values.
        #[inline]
        #[target_feature(enable = $feature)]
        pub unsafe fn short_block<
            T: Element,
            K: Short<A, B, OUT>,
            const A: usize,
            const B: usize,
            const OUT: usize,
            const W: usize,
        >(
            a: Numbers<T, W>,
            b: Numbers<T, W>,
            out: &mut [Lane<W>],
        ) {
            for number in 0..W / $width {
                // SAFETY: a block has `W` rows, and a register holds `$width` numbers.
                let (x, y) = unsafe { (columns_of::<T, A, W>(a, number), columns_of::<T, B, W>(b, number)) };
                let values = K::values::<$width>(numbers_of(x), numbers_of(y));
                for k in 0..OUT {
                    out[k].0.as_chunks_mut().0[number] = values[k];
                }
            }
        }

        /// Applies the function of a link to a group of rows.
        ///
        /// # Safety
        /// As for [`Apply`](crate::simd::short::Apply), of a link with these sizes.
        #[target_feature(enable = $feature)]
        pub unsafe fn link<
            T: Element,
            K: Short<A, B, OUT>,
            const A: usize,
            const B: usize,
            const OUT: usize,
            const W: usize,
        >(
            link: &Link<T, W>,
            group: usize,
            lanes: *mut Lane<W>,
        ) {
            // SAFETY: the link fits, so that it has the rows of the group, and the lanes, which differ from those of the
            // value.
            unsafe {
                let a = link.from[0].numbers(group, A, lanes);
                let b = link.from[1].numbers(group, B, lanes);
                let out = std::slice::from_raw_parts_mut(lanes.add(link.to), OUT);
                short_block::<T, K, A, B, OUT, W>(a, b, out);
            }
        }

        /// Applies all links to whole groups of rows, and writes the values in the lanes from `first` on; returns the
        /// number of rows.
        ///
        /// # Safety
        /// All links fit the groups and the lanes, which include those of the values.
        #[target_feature(enable = $feature)]
        pub unsafe fn chain<T: Element, const OUT: usize>(
            links: &[Link<T>],
            lanes: &mut [Lane<GROUP>],
            first: usize,
            out: &mut [T],
            streamed: bool,
        ) -> usize {
            // SAFETY: passed on.
            unsafe {
                if streamed {
                    chain_to::<T, OUT, true>(links, lanes, first, out)
                } else {
                    chain_to::<T, OUT, false>(links, lanes, first, out)
                }
            }
        }

        /// # Safety
        /// As for [`chain`].
        #[target_feature(enable = $feature)]
        unsafe fn chain_to<T: Element, const OUT: usize, const STREAMED: bool>(
            links: &[Link<T>],
            lanes: &mut [Lane<GROUP>],
            first: usize,
            out: &mut [T],
        ) -> usize {
            let groups = out.len() / (GROUP * OUT);
            let Some(mut writer) = Writer::<STREAMED>::new(out) else { return 0 };
            let out = out.as_mut_ptr();
            for group in 0..groups {
                for link in links {
                    // SAFETY: as the caller promises.
                    unsafe { (link.apply)(link, group, lanes.as_mut_ptr()) };
                }
                let values = Numbers::<T, GROUP>::Lanes(&lanes[first..first + OUT]);
                for number in 0..GROUP / $width {
                    // SAFETY: the group has these columns.
                    let rows = rows_of(unsafe { columns_of::<T, OUT, GROUP>(values, number) });
                    for r in 0..OUT {
                        let place = (GROUP * group + $width * number) * OUT + $width * r;
                        // SAFETY: there is room for so many groups.
                        unsafe { writer.write(out.add(place), rows[r]) };
                    }
                }
            }
            // SAFETY: it wrote these groups.
            unsafe { writer.finish(out.add(GROUP * OUT * groups)) };
            groups * GROUP
        }

        /// The numbers of registers.
        #[inline]
        #[target_feature(enable = $feature)]
        fn numbers_of<const SIZE: usize>(registers: [$register; SIZE]) -> [[f64; $width]; SIZE] {
            let mut numbers = [[0.0; $width]; SIZE];
            for k in 0..SIZE {
                // SAFETY: a register holds `$width` numbers.
                unsafe { f64::$store(numbers[k].as_mut_ptr(), registers[k]) };
            }
            numbers
        }

        /// Applies a function to groups of `$width` rows, and returns the number of rows.
        ///
        /// # Safety
        /// `a` and `b` have as many rows as `out`, or one row where `one` says so.
        #[target_feature(enable = $feature)]
        pub unsafe fn short<
            T: Element,
            K: Short<A, B, OUT>,
            const A: usize,
            const B: usize,
            const OUT: usize,
        >(
            a: &[T],
            b: &[T],
            one: [bool; 2],
            out: &mut [T],
            streamed: bool,
        ) -> usize {
            // SAFETY: passed on.
            unsafe {
                match (one == [false, false], streamed) {
                    (true, false) => groups::<T, K, A, B, OUT, true, false>(a, b, one, out),
                    (true, true) => groups::<T, K, A, B, OUT, true, true>(a, b, one, out),
                    (false, false) => groups::<T, K, A, B, OUT, false, false>(a, b, one, out),
                    (false, true) => groups::<T, K, A, B, OUT, false, true>(a, b, one, out),
                }
            }
        }

        /// `MANY`: neither factor has one row for all.
        ///
        /// # Safety
        /// As for [`short`].
        #[target_feature(enable = $feature)]
        unsafe fn groups<
            T: Element,
            K: Short<A, B, OUT>,
            const A: usize,
            const B: usize,
            const OUT: usize,
            const MANY: bool,
            const STREAMED: bool,
        >(
            a: &[T],
            b: &[T],
            one: [bool; 2],
            out: &mut [T],
        ) -> usize {
            let count = out.len() / ($width * OUT);
            let Some(mut writer) = Writer::<STREAMED>::new(out) else { return 0 };
            let (one_a, one_b) = (filled::<T, A>(a), filled::<T, B>(b));
            for number in 0..count {
                let a = a.as_ptr().wrapping_add($width * A * number);
                let b = b.as_ptr().wrapping_add($width * B * number);
                // SAFETY: the rows are there.
                let x = if MANY || !one[0] { unsafe { read::<T, A>(a) } } else { one_a };
                // SAFETY: as above.
                let y = if MANY || !one[1] { unsafe { read::<T, B>(b) } } else { one_b };
                let values = K::values::<$width>(numbers_of(x), numbers_of(y));
                let mut columns = [$zero(); OUT];
                for k in 0..OUT {
                    // SAFETY: a register holds `$width` numbers.
                    columns[k] = unsafe { f64::$load(values[k].as_ptr()) };
                }
                let rows = rows_of(columns);
                for r in 0..OUT {
                    // SAFETY: there is room for `count` groups.
                    unsafe { writer.write(out.as_mut_ptr().add($width * (OUT * number + r)), rows[r]) };
                }
            }
            // SAFETY: it wrote `count` groups.
            unsafe { writer.finish(out.as_mut_ptr().add($width * OUT * count)) };
            count * $width
        }
    };
}

pub(super) use short;
