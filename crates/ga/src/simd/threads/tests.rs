use super::*;

/// Each row is done once, with its own number, in pieces that are not too small.
#[test]
fn pieces_cover_the_rows() {
    for threads in [0, 1, 2, 3, 7, usize::MAX] {
        for (rows, size, least) in [(0, 3, 1), (1, 3, 1), (100, 3, 1), (100, 1, 40), (100, 2, 0), (5, 0, 1)] {
            let mut out = vec![0; rows * size];
            Threads::new(threads).for_each_piece(least, size, &mut out, |rows, piece| {
                assert_eq!(piece.len(), rows.len() * size);
                assert!(rows.len() >= least.min(rows.end));
                for (row, numbers) in rows.zip(piece.chunks_mut(size.max(1))) {
                    for x in numbers {
                        *x += 1 + row;
                    }
                }
            });
            let expected: Vec<usize> = (0..rows * size).map(|i| 1 + i / size).collect();
            assert_eq!(out, expected);
        }
    }
}
