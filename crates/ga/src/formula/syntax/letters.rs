//! Characters of formulas: letters, subscripts and superscripts in all their spellings.

/// The second character of the pair that begins with this one, which is not ASCII.
fn partner(pairs: &str, first: char) -> Option<char> {
    if first.is_ascii() { None } else { pairs_of(pairs).find(|&(c, _)| c == first).map(|(_, second)| second) }
}

fn pairs_of(pairs: &str) -> impl Iterator<Item = (char, char)> {
    pairs.chars().step_by(2).zip(pairs.chars().skip(1).step_by(2))
}

/// The plain letter for characters that differ only in style, as Python normalizes names, and for the sum sign.
pub(crate) fn folded(c: char) -> char {
    const PAIRS: &str = "µμϐβϑθϕφϖπϰκϱρϵεϴΘ\u{2126}Ω\u{212a}KℎhℓlℯeℐIℑIℒLℛRℜRℝRℬBℰEℱFℋHℳM∑Σ";
    match c {
        '𝐀'..='𝚣' => mathematical(c, '𝐀', &['A', 'a'], 26),
        '𝚨'..='𝟉' => greek(c),
        '𝟎'..='𝟿' => mathematical(c, '𝟎', &['0'], 10),
        'µ' | 'ϐ'..='ϵ' | '\u{2100}'..='∑' => partner(PAIRS, c).unwrap_or(c),
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
    partner("ÃAãaẼEẽeĨIĩiÑNñnÕOõoŨUũuṼVṽvỸYỹy", c)
}

/// The Latin letter that a letter of Cyrillic or Greek looks like.
pub(crate) fn look_alike(c: char) -> Option<char> {
    const CYRILLIC: &str = "аaеeоoрpсcуyхxіiјjѕsԁdһhԛqԝwАAВBЕEКKМMНHОOРPСCТTУYХXІIЈJЅSԚQԜW";
    const GREEK: &str = "οoΑAΒBΕEΖZΗHΙIΚKΜMΝNΟOΡPΤTΥYΧX";
    partner(CYRILLIC, c).or_else(|| partner(GREEK, c))
}

/// The plain character of a subscript.
pub(crate) fn subscript(c: char) -> Option<char> {
    partner("₀0₁1₂2₃3₄4₅5₆6₇7₈8₉9ₐaₑeₕhᵢiⱼjₖkₗlₘmₙnₒoₚpᵣrₛsₜtᵤuᵥvₓxᵦβᵧγᵨρᵩφᵪχ", c)
}

const SUPERSCRIPTS: &str = "⁰0¹1²2³3⁴4⁵5⁶6⁷7⁸8⁹9⁻-⁺+";

/// The digit, `-` or `+` of a superscript.
pub(crate) fn superscript(c: char) -> Option<char> {
    partner(SUPERSCRIPTS, c)
}

/// The superscript of a whole number.
pub(crate) fn raised(number: &str) -> String {
    let raised = |plain| pairs_of(SUPERSCRIPTS).find(|&(_, c)| c == plain).map(|(raised, _)| raised);
    number.chars().filter_map(raised).collect()
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
    COMPOSED
        .into_iter()
        .flat_map(|(mark, pairs)| pairs_of(pairs).map(move |(plain, with)| (plain, mark, with)))
}

/// The number of primes in a character, if it is one.
pub(crate) fn primes(c: char) -> Option<usize> {
    match c {
        '\'' | '′' | '’' => Some(1),
        '″' => Some(2),
        '‴' => Some(3),
        _ => None,
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
mod tests;
