use super::*;
use proptest::prelude::*;

fn shown(text: &str, span: Range<usize>) -> String {
    Diagnostic::at(Path::new("f"), text, span, "m").to_string()
}

#[test]
fn the_caret_stands_under_the_span() {
    assert_eq!(shown("ab\ncde fg\nh", 7..9), "f:2:5: error: m\n  |\n2 | cde fg\n  |     ^^");
    let tenth = "\n".repeat(9) + "xy";
    assert_eq!(shown(&tenth, 9..10), "f:10:1: error: m\n   |\n10 | xy\n   | ^");
}

#[test]
fn tabs_wide_and_combining_characters_keep_the_caret_in_place() {
    assert_eq!(shown("\ta\tb", 3..4), "f:1:4: error: m\n  |\n1 |     a    b\n  |          ^");
    assert_eq!(shown("日本x", 6..7), "f:1:3: error: m\n  |\n1 | 日本x\n  |     ^");
    assert_eq!(shown("日本x", 0..3), "f:1:1: error: m\n  |\n1 | 日本x\n  | ^^");
    assert_eq!(shown("e\u{301}x", 3..4), "f:1:3: error: m\n  |\n1 | e\u{301}x\n  |  ^");
    assert_eq!(
        shown("\u{1b}[1m\u{202e}x", 7..8),
        "f:1:6: error: m\n  |\n1 | \u{fffd}[1m\u{fffd}x\n  |      ^"
    );
}

#[test]
fn ends_of_lines_and_of_the_text_have_a_place() {
    assert_eq!(shown("", 0..0), "f:1:1: error: m\n  |\n1 | \n  | ^");
    assert_eq!(shown("ab\r\ncd", 3..4), "f:1:3: error: m\n  |\n1 | ab\n  |   ^");
    assert_eq!(shown("ab\ncd", 1..5), "f:1:2: error: m\n  |\n1 | ab\n  |  ^");
    assert_eq!(shown("ab\n", 99..99), "f:2:1: error: m\n  |\n2 | \n  | ^");
}

#[test]
fn a_long_line_is_cut_around_the_place() {
    let text = "a".repeat(500) + "XYZ" + &"b".repeat(500);
    let (before, after) = ("a".repeat(30), "b".repeat(67));
    let caret = " ".repeat(31);
    assert_eq!(
        shown(&text, 500..503),
        format!("f:1:501: error: m\n  |\n1 | …{before}XYZ{after}…\n  | {caret}^^^")
    );
}

#[test]
fn near_names_are_found_and_far_ones_are_not() {
    assert_eq!(nearest("durration", ["samples", "duration"]), Some("duration"));
    assert_eq!(nearest("KG", ["g", "kg"]), Some("kg"));
    assert_eq!(nearest("ab", ["abc"]), None);
    assert_eq!(nearest("colour", ["duration", "samples"]), None);
    assert_eq!(nearest(&"x".repeat(1_000_000), ["duration"]), None);
    assert_eq!(edits("kitten", "sitting"), 3);
}

#[test]
fn quoted_text_is_short_and_printable() {
    assert_eq!(quote("a\u{1b}\n"), "`a\\u{1b}\\n`");
    assert_eq!(quote(&"x".repeat(41)), format!("`{}…`", "x".repeat(40)));
    assert_eq!(alternatives(&["a"]), "`a`");
    assert_eq!(alternatives(&["a", "b", "c"]), "one of `a`, `b`, `c`");
}

proptest! {
    #[test]
    fn any_span_of_any_text_has_a_place(text in "(\\PC|[\t\r\n])*", a in 0usize..99, b in 0usize..99) {
        let shown = shown(&text, a..b);
        prop_assert_eq!(shown.lines().count(), 4);
    }
}
