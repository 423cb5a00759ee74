//! From text to an expression, by recursive descent.

use std::f64::consts::{E, PI};

use super::function::{FUNCTIONS, Function};
use super::token::{self, Token};
use super::{Node, Operator, SyntaxError};

/// Parentheses and signs within each other; more would only exhaust the stack.
const MOST_NESTED: usize = 100;

/// What an operand can be.
const OPERAND: &str = "a number, x, y, z, pi, e, a function or (";

/// Characters of an expression; a longer sum would exhaust the stack when it is evaluated.
const MOST_CHARACTERS: usize = 4000;

pub(super) fn parse(text: &str) -> Result<Node, SyntaxError> {
    if text.chars().nth(MOST_CHARACTERS).is_some() {
        return Err(SyntaxError {
            character: MOST_CHARACTERS + 1,
            found: "more".to_owned(),
            expected: format!("at most {MOST_CHARACTERS} characters"),
        });
    }
    let (token, start, end) = token::next(text, 0);
    let mut parser = Parser { text, token, start, end, nested: 0 };
    let root = parser.sum()?;
    match parser.token {
        Token::End => Ok(root),
        _ => Err(parser.expected("an operator (+ - * / ^) or the end")),
    }
}

struct Parser<'a> {
    text: &'a str,
    /// The next word, and where it begins and ends.
    token: Token<'a>,
    start: usize,
    end: usize,
    nested: usize,
}

impl Parser<'_> {
    fn sum(&mut self) -> Result<Node, SyntaxError> {
        let mut node = self.product()?;
        loop {
            let operator = match self.token {
                Token::Symbol('+') => Operator::Plus,
                Token::Symbol('-') => Operator::Minus,
                _ => return Ok(node),
            };
            self.advance();
            node = Node::Binary(operator, Box::new([node, self.product()?]));
        }
    }

    fn product(&mut self) -> Result<Node, SyntaxError> {
        let mut node = self.signed()?;
        loop {
            let operator = match self.token {
                Token::Symbol('*') => Operator::Times,
                Token::Symbol('/') => Operator::Over,
                _ => return Ok(node),
            };
            self.advance();
            node = Node::Binary(operator, Box::new([node, self.signed()?]));
        }
    }

    fn signed(&mut self) -> Result<Node, SyntaxError> {
        if self.nested == MOST_NESTED {
            return Err(self.expected(&format!("at most {MOST_NESTED} parentheses and signs within each other")));
        }
        self.nested += 1;
        let node = match self.token {
            Token::Symbol('-') => {
                self.advance();
                Node::Negative(Box::new(self.signed()?))
            }
            Token::Symbol('+') => {
                self.advance();
                self.signed()?
            }
            _ => self.power()?,
        };
        self.nested -= 1;
        Ok(node)
    }

    fn power(&mut self) -> Result<Node, SyntaxError> {
        let base = self.operand()?;
        if self.token != Token::Symbol('^') {
            return Ok(base);
        }
        self.advance();
        Ok(Node::Binary(Operator::Power, Box::new([base, self.signed()?])))
    }

    fn operand(&mut self) -> Result<Node, SyntaxError> {
        let node = match self.token {
            Token::Number(number) => Node::Number(number),
            Token::Name("x") => Node::Coordinate(0),
            Token::Name("y") => Node::Coordinate(1),
            Token::Name("z") => Node::Coordinate(2),
            Token::Name("pi") => Node::Number(PI),
            Token::Name("e") => Node::Number(E),
            Token::Name(name) => match Function::named(name) {
                Some(function) => return self.call(function),
                None => return Err(self.unknown()),
            },
            Token::Symbol('(') => {
                self.advance();
                let node = self.sum()?;
                self.symbol(')', "an operator or )")?;
                return Ok(node);
            }
            _ => return Err(self.expected(OPERAND)),
        };
        self.advance();
        Ok(node)
    }

    fn call(&mut self, function: Function) -> Result<Node, SyntaxError> {
        self.advance();
        self.symbol('(', &format!("( after {}", function.name()))?;
        let mut arguments = vec![self.sum()?];
        while arguments.len() < function.arity() {
            let expected = format!("an operator or a comma: {} takes {} numbers", function.name(), function.arity());
            self.symbol(',', &expected)?;
            arguments.push(self.sum()?);
        }
        self.symbol(')', "an operator or )")?;
        Ok(Node::Call(function, arguments))
    }

    fn symbol(&mut self, symbol: char, expected: &str) -> Result<(), SyntaxError> {
        if self.token != Token::Symbol(symbol) {
            return Err(self.expected(expected));
        }
        self.advance();
        Ok(())
    }

    fn advance(&mut self) {
        (self.token, self.start, self.end) = token::next(self.text, self.end);
    }

    fn unknown(&self) -> SyntaxError {
        let names: Vec<&str> = FUNCTIONS.into_iter().map(Function::name).collect();
        self.expected(&format!("{OPERAND}; the functions are {}", names.join(", ")))
    }

    fn expected(&self, expected: &str) -> SyntaxError {
        let found = match self.token {
            Token::End => "the end".to_owned(),
            _ => self.text[self.start..self.end].to_owned(),
        };
        let character = self.text[..self.start].chars().count() + 1;
        SyntaxError { character, found, expected: expected.to_owned() }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::super::ScalarField;
    use super::super::Expression;

    fn value(text: &str) -> f64 {
        Expression::parse(text).unwrap_or_else(|e| panic!("{text}: {e}")).value(DVec3::new(2.0, 3.0, 5.0))
    }

    #[test]
    fn precedence_is_that_of_mathematics() {
        for (text, expected) in [
            ("-x^2", -4.0),
            ("(-x)^2", 4.0),
            ("2^3^2", 512.0),
            ("2^-1", 0.5),
            ("8/2/2", 2.0),
            ("6/2*3", 9.0),
            ("2-3+4", 3.0),
            ("x+y*z", 17.0),
            ("2*-x^2", -8.0),
            ("--x", 2.0),
            ("+x - -y", 5.0),
            ("1.5e2*x", 300.0),
            ("min(1, max(x, y))", 1.0),
            ("max(min(x, y), min(z, 4)) ^ 2", 16.0),
            ("sqrt(x*x + y*y + 3)", 4.0),
            ("hypot(y, 4)", 5.0),
            ("mod(-1, 3)", 2.0),
            ("2*cos(pi) + ln(e)", -1.0),
            ("\n( x )\t", 2.0),
        ] {
            assert_eq!(value(text), expected, "{text}");
        }
    }

    #[test]
    fn no_nan_is_lost() {
        for text in ["max(1, ln(-x))", "min(ln(-x), 1)", "max(ln(-x), 1)", "min(1, 0/0)"] {
            assert!(value(text).is_nan(), "{text} is {}", value(text));
        }
    }

    #[test]
    fn a_mistake_is_named_with_its_place() {
        let deep = "(".repeat(1000);
        let long = "x+".repeat(3000);
        for (text, character, found, expected) in [
            ("x + t", 5, "t", "a number, x, y, z, pi"),
            ("2x", 2, "x", "an operator"),
            ("x +", 4, "the end", "a number"),
            ("", 1, "the end", "a number"),
            ("(x", 3, "the end", "an operator or )"),
            ("x)", 2, ")", "an operator (+ - * / ^) or the end"),
            ("x**2", 3, "*", "a number"),
            ("sin x", 5, "x", "( after sin"),
            ("max(x)", 6, ")", "max takes 2 numbers"),
            ("sin(x, y)", 6, ",", "an operator or )"),
            ("é + 1.2.3", 1, "é", "a number"),
            ("x + 1.2.3", 5, "1.2.3", "a number"),
            ("ä*x > 1", 1, "ä", "the functions are abs"),
            ("x > 1", 3, ">", "an operator"),
            (&long, 4001, "more", "at most 4000 characters"),
            (&deep, 101, "(", "at most 100 parentheses"),
        ] {
            let error = Expression::parse(text).expect_err(text);
            assert_eq!((error.character, error.found.as_str()), (character, found), "{text}: {error}");
            assert!(error.expected.contains(expected), "{text}: found {error}, expected {expected}");
        }
    }
}
