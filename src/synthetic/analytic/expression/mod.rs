//! Arithmetic expressions in x, y and z.
//!
//! ```text
//! sum      = product { ("+" | "-") product }
//! product  = signed { ("*" | "/") signed }
//! signed   = ("+" | "-") signed | power
//! power    = operand [ "^" signed ]
//! operand  = number | "x" | "y" | "z" | "pi" | "e" | function "(" sum { "," sum } ")" | "(" sum ")"
//! ```
//!
//! Precedence is that of mathematics: `-x^2` is −(x²), and `2^3^2` is 2^(3²). A multiplication is always written.

mod function;
mod parse;
mod token;

use glam::DVec3;

use super::ScalarField;
use function::Function;

/// An arithmetic expression in the coordinates x, y and z (LPS, mm).
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    root: Node,
}

/// Why a text is no expression.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("character {character}: found {found}, expected {expected}")]
pub struct SyntaxError {
    /// Where in the text, counted in characters from 1.
    pub character: usize,
    /// What is there.
    pub found: String,
    /// What could be there.
    pub expected: String,
}

impl Expression {
    /// Reads an expression.
    ///
    /// # Errors
    /// The first character that fits no expression, what is there and what was expected.
    pub fn parse(text: &str) -> Result<Self, SyntaxError> {
        parse::parse(text).map(|root| Expression { root })
    }
}

impl ScalarField for Expression {
    fn value(&self, at_mm: DVec3) -> f64 {
        self.root.value(at_mm)
    }
}

/// A part of an expression.
#[derive(Debug, Clone, PartialEq)]
enum Node {
    Number(f64),
    /// x, y or z, by its axis.
    Coordinate(usize),
    Negative(Box<Node>),
    Binary(Operator, Box<[Node; 2]>),
    Call(Function, Vec<Node>),
}

/// An operator between two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Operator {
    Plus,
    Minus,
    Times,
    Over,
    Power,
}

impl Node {
    fn value(&self, at: DVec3) -> f64 {
        match self {
            Node::Number(number) => *number,
            Node::Coordinate(axis) => at[*axis],
            Node::Negative(node) => -node.value(at),
            Node::Binary(operator, operands) => {
                let [a, b] = [operands[0].value(at), operands[1].value(at)];
                match operator {
                    Operator::Plus => a + b,
                    Operator::Minus => a - b,
                    Operator::Times => a * b,
                    Operator::Over => a / b,
                    Operator::Power => a.powf(b),
                }
            }
            Node::Call(function, arguments) => match (function, arguments.as_slice()) {
                (Function::One(_, f), [a]) => f(a.value(at)),
                (Function::Two(_, f), [a, b]) => f(a.value(at), b.value(at)),
                // The parser lets no other number of arguments pass.
                _ => f64::NAN,
            },
        }
    }
}
