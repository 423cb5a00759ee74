//! The words of an expression.

/// A word of an expression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Token<'a> {
    Number(f64),
    Name(&'a str),
    Symbol(char),
    /// Behind the last word.
    End,
}

/// The next word of a text, after blanks, with where it begins and ends, in bytes. Digits that are no number, such as
/// `1.2.3`, are a name, which nothing has.
pub(super) fn next(text: &str, from: usize) -> (Token<'_>, usize, usize) {
    let blanks = text[from..].find(|c: char| !c.is_whitespace());
    let Some(start) = blanks.map(|blanks| from + blanks) else { return (Token::End, text.len(), text.len()) };
    let rest = &text[start..];
    let first = rest.chars().next().unwrap_or(' ');
    if first.is_ascii_digit() || first == '.' {
        let word = &rest[..number_length(rest)];
        let token = word.parse().map_or(Token::Name(word), Token::Number);
        return (token, start, start + word.len());
    }
    if first.is_alphabetic() || first == '_' {
        let word = &rest[..rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len())];
        return (Token::Name(word), start, start + word.len());
    }
    (Token::Symbol(first), start, start + first.len_utf8())
}

/// Bytes of a number at the start of a text: digits with points, and an exponent where digits follow.
fn number_length(text: &str) -> usize {
    let digits = |text: &str| text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len());
    let mantissa = digits(text);
    let exponent = text[mantissa..].strip_prefix(['e', 'E']);
    let unsigned = exponent.map(|rest| rest.strip_prefix(['+', '-']).unwrap_or(rest));
    match unsigned {
        Some(rest) if rest.starts_with(|c: char| c.is_ascii_digit()) => text.len() - rest.len() + digits(rest),
        _ => mantissa,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_told_apart() {
        let text = "1.5e-3*x1+.5 (2e";
        let mut found = Vec::new();
        let mut at = 0;
        while let (token, _, end) = next(text, at)
            && token != Token::End
        {
            found.push(token);
            at = end;
        }
        let expected = [
            Token::Number(1.5e-3),
            Token::Symbol('*'),
            Token::Name("x1"),
            Token::Symbol('+'),
            Token::Number(0.5),
            Token::Symbol('('),
            Token::Number(2.0),
            Token::Name("e"),
        ];
        assert_eq!(found, expected);
        assert_eq!(next("1.2.3", 0).0, Token::Name("1.2.3"), "no number");
    }
}
