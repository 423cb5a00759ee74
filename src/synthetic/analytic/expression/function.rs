//! The functions that an expression may call.

/// A function by its name.
#[derive(Debug, Clone, Copy)]
pub(super) enum Function {
    /// Of one argument.
    One(&'static str, fn(f64) -> f64),
    /// Of two.
    Two(&'static str, fn(f64, f64) -> f64),
}

/// All of them, in the order in which messages name them. Angles are in radians. The greater and the smaller of a number
/// and NaN is NaN, so that no NaN is lost before it is reported.
pub(super) const FUNCTIONS: [Function; 23] = [
    Function::One("abs", f64::abs),
    Function::One("sqrt", f64::sqrt),
    Function::One("cbrt", f64::cbrt),
    Function::One("exp", f64::exp),
    Function::One("ln", f64::ln),
    Function::One("log10", f64::log10),
    Function::One("sin", f64::sin),
    Function::One("cos", f64::cos),
    Function::One("tan", f64::tan),
    Function::One("asin", f64::asin),
    Function::One("acos", f64::acos),
    Function::One("atan", f64::atan),
    Function::One("sinh", f64::sinh),
    Function::One("cosh", f64::cosh),
    Function::One("tanh", f64::tanh),
    Function::One("floor", f64::floor),
    Function::One("ceil", f64::ceil),
    Function::One("round", f64::round),
    Function::Two("min", |a, b| if a < b || a.is_nan() { a } else { b }),
    Function::Two("max", |a, b| if a > b || a.is_nan() { a } else { b }),
    Function::Two("hypot", f64::hypot),
    Function::Two("atan2", f64::atan2),
    Function::Two("mod", f64::rem_euclid),
];

impl Function {
    /// The function of this name.
    pub(super) fn named(name: &str) -> Option<Function> {
        FUNCTIONS.into_iter().find(|function| function.name() == name)
    }

    /// Its name.
    pub(super) fn name(self) -> &'static str {
        match self {
            Function::One(name, _) | Function::Two(name, _) => name,
        }
    }

    /// How many arguments it takes.
    pub(super) fn arity(self) -> usize {
        match self {
            Function::One(..) => 1,
            Function::Two(..) => 2,
        }
    }
}

impl PartialEq for Function {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}
