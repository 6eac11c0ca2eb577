use super::*;

#[test]
fn styles_of_letters_fold_to_the_letter() {
    let cases =
        [('𝑎', 'a'), ('𝐑', 'R'), ('𝛀', 'Ω'), ('𝜃', 'θ'), ('𝜑', 'φ'), ('𝟙', '1'), ('ϕ', 'φ'), ('𝒛', 'z')];
    for (styled, plain) in cases {
        assert_eq!(folded(styled), plain, "{styled}");
    }
    assert_eq!(below_tilde('Ã'), Some('A'));
    assert_eq!((composed('x', '\u{307}'), decomposed('ẋ')), (Some('ẋ'), Some(('x', '\u{307}'))));
    assert_eq!((composed('n', '\u{302}'), decomposed('x')), (None, None));
    assert_eq!((look_alike('е'), look_alike('Α'), look_alike('e')), (Some('e'), Some('A'), None));
    assert_eq!(subscript('₇'), Some('7'));
    assert_eq!(superscript('⁷'), Some('7'));
}
