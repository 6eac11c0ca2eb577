//! Syntax of the languages: a table of words, and the frame of a function.

use super::scalars::{Atom, Call, Line, Scalar};
use crate::product::named;

named! {
    /// The languages in which a formula can be written as a function.
    Language: 4 {
        /// Python with NumPy, for single values and batches.
        Python "python",
        /// C99, and C++.
        C "c",
        /// Rust.
        Rust "rust",
        /// GLSL ES 3.00, and GLSL 3.30.
        Glsl "glsl",
    }
}

/// An argument of a function.
pub(super) struct Argument {
    pub name: String,
    /// The number of components; none for a plain number.
    pub size: Option<usize>,
}

/// A function to be written.
pub(super) struct Function<'a> {
    pub name: &'a str,
    /// What it computes, lines of text.
    pub about: Vec<String>,
    pub arguments: Vec<Argument>,
    /// For each input of the program, its argument.
    pub places: Vec<usize>,
    /// The lines, and the number of each that is in use, from 1 on.
    pub lines: &'a [Line],
    pub numbers: Vec<Option<usize>>,
    pub result: Vec<Scalar>,
    /// Whether the result is a plain number.
    pub is_number: bool,
}

/// Words of the languages and names in the code, which names of arguments must not be.
const RESERVED: &str = "auto break case char const continue default do double else enum extern float for goto if inline \
    int long register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while \
    as async await crate dyn fn impl in let loop match mod move mut pub ref self Self super trait true false type unsafe \
    use where yield abstract become box final gen macro override priv try typeof unsized virtual \
    and assert class def del elif except finally from global import is lambda None nonlocal not or pass raise with True \
    False inout out attribute buffer centroid coherent discard flat highp invariant layout lowp mediump patch precision \
    sample shared smooth subroutine uniform varying bool uint active asm cast common external filter fixed half input \
    interface namespace noinline output partition public resource superp template this using vec2 vec3 vec4 mat2 mat3 mat4 \
    delete explicit export friend mutable new operator private protected throw typeid typename catch \
    abs atan atan2 cos cosh exp fabs fmax log main max np result sin sinh sqrt tan f64";

/// Whether a function may have this name: an ASCII identifier that no language reserves.
pub fn is_function_name(name: &str) -> bool {
    let letters = name.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_');
    let reserved = RESERVED.split_ascii_whitespace().any(|word| word == name) || name.starts_with("gl_");
    let number = name.strip_prefix('t').filter(|rest| !rest.is_empty());
    let local = number.is_some_and(|rest| rest.bytes().all(|c| c.is_ascii_digit()));
    letters
        && !reserved
        && !local
        && !name.contains("__")
        && !name.starts_with(|c: char| c.is_ascii_digit())
        && !name.is_empty()
}

impl Language {
    /// What begins a comment.
    fn comment(self) -> &'static str {
        if self == Language::Python { "#" } else { "//" }
    }

    /// What surrounds the name of a local constant: before it, and after the line.
    fn local(self) -> (&'static str, &'static str) {
        match self {
            Language::Python => ("", ""),
            Language::C => ("const double ", ";"),
            Language::Rust => ("let ", ";"),
            Language::Glsl => ("float ", ";"),
        }
    }

    fn call(self, call: Call) -> &'static str {
        let [python, c, rust, glsl] = match call {
            Call::Sqrt => ["np.sqrt", "sqrt", "f64::sqrt", "sqrt"],
            Call::Exp => ["np.exp", "exp", "f64::exp", "exp"],
            Call::Log => ["np.log", "log", "f64::ln", "log"],
            Call::Sin => ["np.sin", "sin", "f64::sin", "sin"],
            Call::Cos => ["np.cos", "cos", "f64::cos", "cos"],
            Call::Tan => ["np.tan", "tan", "f64::tan", "tan"],
            Call::Sinh => ["np.sinh", "sinh", "f64::sinh", "sinh"],
            Call::Cosh => ["np.cosh", "cosh", "f64::cosh", "cosh"],
            Call::Atan2 => ["np.arctan2", "atan2", "f64::atan2", "atan"],
            Call::Abs => ["np.abs", "fabs", "f64::abs", "abs"],
            Call::Max => ["np.maximum", "fmax", "f64::max", "max"],
        };
        match self {
            Language::Python => python,
            Language::C => c,
            Language::Rust => rust,
            Language::Glsl => glsl,
        }
    }

    /// The source of a function.
    pub(super) fn write(self, function: &Function) -> String {
        let comment = |line: &String| format!("{} {line}", self.comment()).trim_end().to_owned() + "\n";
        let mut text: String = function.about.iter().map(comment).collect();
        text += &self.head(function);
        let (before, after) = self.local();
        for (line, number) in function.lines.iter().zip(&function.numbers) {
            if let Some(number) = number {
                text += &format!("    {before}t{number} = {}{after}\n", self.line(function, line));
            }
        }
        text + &self.foot(function)
    }

    /// The lines before the arithmetic.
    fn head(self, function: &Function) -> String {
        let name = function.name;
        let list = |each: &dyn Fn(&str, Option<usize>) -> String| -> Vec<String> {
            function.arguments.iter().map(|argument| each(&argument.name, argument.size)).collect()
        };
        let size = function.result.len();
        match self {
            Language::Python => {
                let moved = |name: &str, size: Option<usize>| {
                    size.map_or(String::new(), |_| format!("    {name} = np.moveaxis({name}, -1, 0)\n"))
                };
                let names = list(&|name, _| name.to_owned()).join(", ");
                format!("import numpy as np\n\n\ndef {name}({names}):\n{}", list(&moved).concat())
            }
            Language::C => {
                let mut arguments = list(&|name, size| match size {
                    Some(size) => format!("const double {name}[{size}]"),
                    None => format!("double {name}"),
                });
                let kind = if function.is_number { "double" } else { "void" };
                if !function.is_number {
                    arguments.push(format!("double result[{size}]"));
                } else if arguments.is_empty() {
                    arguments.push("void".to_owned());
                }
                format!("#include <math.h>\n\n{kind} {name}({}) {{\n", arguments.join(", "))
            }
            Language::Rust => {
                let arguments = list(&|name, size| match size {
                    Some(size) => format!("{name}: [f64; {size}]"),
                    None => format!("{name}: f64"),
                });
                let kind = if function.is_number { "f64".to_owned() } else { format!("[f64; {size}]") };
                let allowed = "#[allow(non_snake_case, unused_variables)]";
                format!("{allowed}\npub fn {name}({}) -> {kind} {{\n", arguments.join(", "))
            }
            Language::Glsl => {
                let mut arguments = list(&|name, size| match size {
                    Some(size) => format!("in float {name}[{size}]"),
                    None => format!("in float {name}"),
                });
                let kind = if function.is_number { "float" } else { "void" };
                if !function.is_number {
                    arguments.push(format!("out float result[{size}]"));
                }
                format!("{kind} {name}({}) {{\n", arguments.join(", "))
            }
        }
    }

    /// The lines after the arithmetic.
    fn foot(self, function: &Function) -> String {
        let result: Vec<String> = function.result.iter().map(|x| self.scalar(function, *x)).collect();
        let list = result.join(", ");
        match self {
            Language::Python if function.is_number => format!("    return {list}\n"),
            Language::Python => format!("    return np.stack(np.broadcast_arrays({list}), axis=-1)\n"),
            Language::Rust if function.is_number => format!("    {list}\n}}\n"),
            Language::Rust => format!("    [{list}]\n}}\n"),
            Language::C | Language::Glsl if function.is_number => format!("    return {list};\n}}\n"),
            Language::C | Language::Glsl => {
                let set = |(k, x): (usize, &String)| format!("    result[{k}] = {x};\n");
                result.iter().enumerate().map(set).collect::<String>() + "}\n"
            }
        }
    }

    fn line(self, function: &Function, line: &Line) -> String {
        match line {
            Line::Sum(terms) => {
                let mut text = String::new();
                for (i, (a, b)) in terms.iter().enumerate() {
                    text += match (i, a.negative) {
                        (0, false) => "",
                        (0, true) => "-",
                        (_, false) => " + ",
                        (_, true) => " - ",
                    };
                    text += &self.atom(function, a.atom);
                    text += &b.map_or(String::new(), |b| " * ".to_owned() + &self.atom(function, b));
                }
                text
            }
            Line::Quotient(a, b) => format!("{} / {}", self.scalar(function, *a), self.scalar(function, *b)),
            Line::Call(call, arguments) => {
                let list: Vec<String> = arguments.iter().map(|x| self.scalar(function, *x)).collect();
                format!("{}({})", self.call(*call), list.join(", "))
            }
        }
    }

    fn scalar(self, function: &Function, Scalar { negative, atom }: Scalar) -> String {
        let text = self.atom(function, atom);
        if negative { format!("-{text}") } else { text }
    }

    fn atom(self, function: &Function, atom: Atom) -> String {
        match atom {
            Atom::Number(bits) => format!("{:?}", f64::from_bits(bits)),
            Atom::Line(line) => format!("t{}", function.numbers[line].unwrap_or_default()),
            Atom::Component(input, k) => {
                let argument = &function.arguments[function.places[input]];
                if argument.size.is_some() {
                    format!("{}[{k}]", argument.name)
                } else {
                    argument.name.clone()
                }
            }
        }
    }
}
