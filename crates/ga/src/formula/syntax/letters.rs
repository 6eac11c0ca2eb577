//! Characters of formulas: letters, subscripts and superscripts in all their spellings.

/// The plain letter for characters that differ only in style, as Python normalizes names, and for the sum sign.
pub(crate) fn folded(c: char) -> char {
    match c {
        'µ' => 'μ',
        'ϐ' => 'β',
        'ϑ' => 'θ',
        'ϕ' => 'φ',
        'ϖ' => 'π',
        'ϰ' => 'κ',
        'ϱ' => 'ρ',
        'ϵ' => 'ε',
        'ϴ' => 'Θ',
        '\u{2126}' => 'Ω',
        '\u{212a}' => 'K',
        'ℎ' => 'h',
        'ℓ' => 'l',
        'ℯ' => 'e',
        'ℐ' | 'ℑ' => 'I',
        'ℒ' => 'L',
        'ℛ' | 'ℜ' | 'ℝ' => 'R',
        'ℬ' => 'B',
        'ℰ' => 'E',
        'ℱ' => 'F',
        'ℋ' => 'H',
        'ℳ' => 'M',
        '∑' => 'Σ',
        '𝐀'..='𝚣' => mathematical(c, '𝐀', &['A', 'a'], 26),
        '𝚨'..='𝟉' => greek(c),
        '𝟎'..='𝟿' => mathematical(c, '𝟎', &['0'], 10),
        _ => c,
    }
}

/// Alphabets in bold, italic, script and so on, one after the other.
fn mathematical(c: char, first: char, alphabets: &[char], letters: u32) -> char {
    let at = c as u32 - first as u32;
    let alphabet = alphabets[(at / letters) as usize % alphabets.len()];
    char::from_u32(alphabet as u32 + at % letters).unwrap_or(c)
}

/// The five mathematical styles of Greek: Α … Ω with a second theta, ∇, α … ω, ∂ and six variants.
fn greek(c: char) -> char {
    let at = (c as u32 - '𝚨' as u32) % 58;
    match at {
        17 => 'Θ',
        0..=24 => char::from_u32('Α' as u32 + at).unwrap_or(c),
        26..=50 => char::from_u32('α' as u32 + at - 26).unwrap_or(c),
        52 => 'ε',
        53 => 'θ',
        54 => 'κ',
        55 => 'φ',
        56 => 'ρ',
        57 => 'π',
        _ => c,
    }
}

/// The plain letter below a tilde, where Unicode has both as one character.
pub(crate) fn below_tilde(c: char) -> Option<char> {
    const PAIRS: &str = "ÃAãaẼEẽeĨIĩiÑNñnÕOõoŨUũuṼVṽvỸYỹy";
    let mut letters = PAIRS.chars();
    while let (Some(with), Some(without)) = (letters.next(), letters.next()) {
        if with == c {
            return Some(without);
        }
    }
    None
}

/// The plain character of a subscript.
pub(crate) fn subscript(c: char) -> Option<char> {
    const PAIRS: &str = "ₐaₑeₕhᵢiⱼjₖkₗlₘmₙnₒoₚpᵣrₛsₜtᵤuᵥvₓxᵦβᵧγᵨρᵩφᵪχ";
    if let '₀'..='₉' = c {
        return char::from_digit(c as u32 - '₀' as u32, 10);
    }
    let mut letters = PAIRS.chars();
    while let (Some(low), Some(plain)) = (letters.next(), letters.next()) {
        if low == c {
            return Some(plain);
        }
    }
    None
}

/// The digit, `-` or `+` of a superscript.
pub(crate) fn superscript(c: char) -> Option<char> {
    let plain = match c {
        '⁰' => '0',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁴'..='⁹' => return char::from_digit(c as u32 - '⁴' as u32 + 4, 10),
        '⁻' => '-',
        '⁺' => '+',
        _ => return None,
    };
    Some(plain)
}

/// Signs that are subscripts by themselves: parallel and perpendicular parts.
pub(crate) fn part_sign(c: char) -> Option<char> {
    match c {
        '∥' | '‖' => Some('∥'),
        '⊥' | '⟂' => Some('⊥'),
        _ => None,
    }
}

/// The tilde above a letter.
pub(crate) const TILDE: char = '\u{303}';

/// Marks above, below or through a letter.
pub(crate) fn is_mark(c: char) -> bool {
    matches!(c, '\u{300}'..='\u{36f}' | '\u{1ab0}'..='\u{1aff}' | '\u{20d0}'..='\u{20ff}')
}

/// Letters followed by the character that combines them with a mark, as Python normalizes names.
const COMPOSED: [(char, &str); 8] = [
    ('\u{307}', "AȦBḂCĊDḊEĖFḞGĠHḢIİMṀNṄOȮPṖRṘSṠTṪWẆXẊYẎZŻaȧbḃcċdḋeėfḟgġhḣmṁnṅoȯpṗrṙsṡtṫwẇxẋyẏzż"),
    ('\u{308}', "AÄEËHḦIÏOÖUÜWẄXẌYŸaäeëhḧiïoötẗuüwẅxẍyÿΙΪΥΫιϊυϋ"),
    ('\u{302}', "AÂCĈEÊGĜHĤIÎJĴOÔSŜUÛWŴYŶZẐaâcĉeêgĝhĥiîjĵoôsŝuûwŵyŷzẑ"),
    ('\u{304}', "AĀEĒGḠIĪOŌUŪYȲaāeēgḡiīoōuūyȳΑᾹΙῙΥῩαᾱιῑυῡ"),
    (
        '\u{301}',
        "AÁCĆEÉGǴIÍKḰLĹMḾNŃOÓPṔRŔSŚUÚWẂYÝZŹaácćeégǵiíkḱlĺmḿnńoópṕrŕsśuúwẃyýzźΑΆΕΈΗΉΙΊΟΌΥΎΩΏαάεέηήιίοόυύωώ",
    ),
    ('\u{300}', "AÀEÈIÌNǸOÒUÙWẀYỲaàeèiìnǹoòuùwẁyỳΑᾺΕῈΗῊΙῚΟῸΥῪΩῺαὰεὲηὴιὶοὸυὺωὼ"),
    ('\u{30c}', "AǍCČDĎEĚGǦHȞIǏKǨLĽNŇOǑRŘSŠTŤUǓZŽaǎcčdďeěgǧhȟiǐjǰkǩlľnňoǒrřsštťuǔzž"),
    ('\u{306}', "AĂEĔGĞIĬOŎUŬaăeĕgğiĭoŏuŭΑᾸΙῘΥῨαᾰιῐυῠ"),
];

/// The character that combines a letter and a mark.
pub(crate) fn composed(letter: char, mark: char) -> Option<char> {
    pairs().find(|&(plain, m, _)| (plain, m) == (letter, mark)).map(|(_, _, with)| with)
}

/// The letter and the mark of a combined character.
pub(crate) fn decomposed(c: char) -> Option<(char, char)> {
    pairs().find(|&(_, _, with)| with == c).map(|(plain, mark, _)| (plain, mark))
}

/// Each letter, mark, and their combination.
fn pairs() -> impl Iterator<Item = (char, char, char)> {
    COMPOSED.into_iter().flat_map(|(mark, letters)| {
        let plain = letters.chars().step_by(2);
        plain.zip(letters.chars().skip(1).step_by(2)).map(move |(plain, with)| (plain, mark, with))
    })
}

/// The number of primes in a character.
pub(crate) fn primes(c: char) -> usize {
    match c {
        '\'' | '′' | '’' => 1,
        '″' => 2,
        '‴' => 3,
        _ => 0,
    }
}

/// Whether a name may begin with it; raised and lowered letters may not.
pub(crate) fn is_letter(c: char) -> bool {
    c.is_alphabetic()
        && subscript(c).is_none()
        && !matches!(c, 'ª' | 'º' | '\u{2b0}'..='\u{2ff}' | '\u{1d2c}'..='\u{1d6a}' | 'ⁱ' | 'ⁿ')
}

/// Spaces, including invisible operators such as invisible times.
pub(crate) fn is_space(c: char) -> bool {
    c.is_whitespace() || matches!(c, '\u{200b}' | '\u{2060}'..='\u{2064}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
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
        assert_eq!(subscript('₇'), Some('7'));
        assert_eq!(superscript('⁷'), Some('7'));
    }
}
