use super::*;

/// The whole table of G3 as text: row times column.
#[test]
fn g3_table_is_pinned() {
    let names = ["1", "e1", "e2", "e3", "e23", "e31", "e12", "I"];
    let text: Vec<String> = (0..8)
        .map(|i| {
            let row: Vec<String> = (0..8)
                .map(|j| {
                    let (s, k) = G3.basis_product(i, j);
                    format!("{:>4}", format!("{}{}", if s < 0 { "-" } else { "" }, names[k]))
                })
                .collect();
            row.concat()
        })
        .collect();
    let expected = [
        "   1  e1  e2  e3 e23 e31 e12   I",
        "  e1   1 e12-e31   I -e3  e2 e23",
        "  e2-e12   1 e23  e3   I -e1 e31",
        "  e3 e31-e23   1 -e2  e1   I e12",
        " e23   I -e3  e2  -1-e12 e31 -e1",
        " e31  e3   I -e1 e12  -1-e23 -e2",
        " e12 -e2  e1   I-e31 e23  -1 -e3",
        "   I e23 e31 e12 -e1 -e2 -e3  -1",
    ];
    assert_eq!(text, expected);
}

/// Associativity and the defining relations, for every signature of up to four generators.
#[test]
fn every_small_algebra_is_associative() {
    for n in 0..=4 {
        for p in 0..=n {
            for q in 0..=n - p {
                let algebra = Algebra::new(Signature { p, q, r: n - p - q }).unwrap();
                let size = algebra.blades().len();
                for (i, j, k) in (0..size * size * size).map(|x| (x / size / size, x / size % size, x % size))
                {
                    let (s, ij) = algebra.basis_product(i, j);
                    let (t, left) = algebra.basis_product(ij, k);
                    let (u, jk) = algebra.basis_product(j, k);
                    let (v, right) = algebra.basis_product(i, jk);
                    assert_eq!((s * t, left), (u * v, right));
                }
                for g in 0..n {
                    let expected = algebra.signature().square(g);
                    assert_eq!(algebra.basis_product(1 + g, 1 + g), (expected, 0));
                }
            }
        }
    }
}

#[test]
fn order_is_by_grade_then_generators() {
    let algebra = Algebra::new(Signature { p: 4, q: 0, r: 0 }).unwrap();
    let bits: Vec<u32> = algebra.blades()[5..11].iter().map(|b| b.bits).collect();
    assert_eq!(bits, [0b0011, 0b0101, 0b1001, 0b0110, 0b1010, 0b1100]);
    assert!(Algebra::new(Signature { p: 9, q: 0, r: 0 }).is_none());
}
