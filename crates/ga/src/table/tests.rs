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
                check_associative(&algebra);
                for g in 0..n {
                    let expected = algebra.squares()[g];
                    assert_eq!(algebra.basis_product(1 + g, 1 + g), (expected, 0));
                }
            }
        }
    }
}

fn check_associative(algebra: &Algebra) {
    let size = algebra.blades().len();
    for (i, j, k) in (0..size * size * size).map(|x| (x / size / size, x / size % size, x % size)) {
        let (s, ij) = algebra.basis_product(i, j);
        let (t, left) = algebra.basis_product(ij, k);
        let (u, jk) = algebra.basis_product(j, k);
        let (v, right) = algebra.basis_product(i, jk);
        assert_eq!((s * t, left), (u * v, right));
    }
}

/// The basis of bivector.net; each element and that as far from the end are complements.
#[test]
fn plane_based_algebras_have_e0_first() {
    let names = |algebra: &Algebra| -> Vec<String> {
        let name = |blade: &Blade| {
            let generators = (0..8).filter(|i| blade.bits >> i & 1 == 1);
            let digits: String = generators.map(|i| i.to_string()).collect();
            format!("{}{digits}", if blade.sign < 0 { "-" } else { "" })
        };
        algebra.blades().iter().map(name).collect()
    };
    assert_eq!(names(&Algebra::pga(2).unwrap()), ["", "0", "1", "2", "01", "-02", "12", "012"]);
    let space =
        ["", "0", "1", "2", "3", "01", "02", "03", "12", "-13", "23", "-012", "013", "-023", "123", "0123"];
    assert_eq!(names(&Algebra::pga(3).unwrap()), space);
    for n in 1..=4 {
        let algebra = Algebra::pga(n).unwrap();
        assert_eq!(algebra.signature(), Signature { p: n, q: 0, r: 1 });
        assert_eq!(algebra.numbers(), 0..n + 1);
        check_associative(&algebra);
        let last = algebra.blades().len() - 1;
        assert!(algebra.blades().is_sorted_by_key(|blade| blade.grade()));
        for k in 0..=last / 2 {
            assert_eq!(algebra.basis_product(k, last - k), (1, last));
        }
    }
    assert!(Algebra::pga(8).is_none());
}

#[test]
fn order_is_by_grade_then_generators() {
    let algebra = Algebra::new(Signature { p: 4, q: 0, r: 0 }).unwrap();
    let bits: Vec<u32> = algebra.blades()[5..11].iter().map(|b| b.bits).collect();
    assert_eq!(bits, [0b0011, 0b0101, 0b1001, 0b0110, 0b1010, 0b1100]);
    assert!(Algebra::new(Signature { p: 9, q: 0, r: 0 }).is_none());
}
