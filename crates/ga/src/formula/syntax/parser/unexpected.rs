//! Errors for items where no operand can begin.

use super::Parser;
use crate::formula::Error;
use crate::formula::syntax::token::Item;
use crate::formula::syntax::tree::Tight;

impl Parser<'_> {
    /// The error for the next item, or for the end of the text.
    pub(super) fn unexpected(&self) -> Error {
        let reverse = self.reverse_in_other_notation();
        let Some(read) = self.ahead(0) else {
            let message = "the formula ends where a name, a number or an opening bracket is expected";
            return Error::new(self.span(), message.to_owned() + reverse);
        };
        let text = self.slice(read.span);
        let message = match &read.item {
            _ if !reverse.is_empty() => {
                format!("expected a name, a number or an opening bracket, got `{text}`{reverse}")
            }
            Item::Close(_) | Item::CloseAngle if self.depth == 0 => {
                format!("`{text}` closes no bracket")
            }
            Item::Tight(Tight::Dot) if text == "|" => {
                "`|` is a dot product, `a|b`, and needs its left factor; a magnitude is `norm(a)`".to_owned()
            }
            Item::Comma => {
                "commas are allowed only between arguments of a function; write a vector as `1 e1 + 2 e2 + 3 e3`"
                    .to_owned()
            }
            Item::Underscore => "a subscript must directly follow a letter or `⟨…⟩`".to_owned(),
            Item::Subscript(_) => "a subscript must directly follow a letter or `⟩`".to_owned(),
            Item::Prime => "a prime must directly follow a letter or a bracket".to_owned(),
            Item::Superscript(_) => "a power must follow its base; powers of powers need brackets".to_owned(),
            _ => format!("expected a name, a number or an opening bracket, got `{text}`"),
        };
        Error::new(read.span, message)
    }

    /// What to write for `R*`, `R^*`, `R^†` and `R^~`.
    fn reverse_in_other_notation(&self) -> &'static str {
        let before = |count: usize| {
            self.at.checked_sub(count).and_then(|at| self.items.get(at)).map(|token| &token.item)
        };
        let next = self.peek();
        let raised = matches!(
            (before(2), before(1), next),
            (_, Some(Item::Caret), Some(Item::Star | Item::Dagger | Item::Tilde))
                | (Some(Item::Caret), Some(Item::Tilde), _)
        );
        let starred = before(1) == Some(&Item::Star) && !matches!(next, Some(Item::Star | Item::Slash));
        if raised || starred { "; write a reverse as `~R`, `R~` or `R†`" } else { "" }
    }
}
