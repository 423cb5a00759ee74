//! What each class of voxels shows.

use crate::transfer::TransferFunction;

/// Hides classes of voxels, or gives them a transfer function of their own.
///
/// **Definition.** At each point the class of the nearest voxel ([`Classes`](crate::volume::Classes)) decides. What is hidden
/// neither absorbs nor emits and casts no shadow; its values count neither for a projection nor for level surfaces. The value,
/// the gradient and the gradient magnitude are those of the whole field: a mask has no gradient of its own, and a level
/// surface has no crossing where a class ends.
///
/// A class without an entry is shown, and so is all of a volume without classes.
#[derive(Debug, Clone, PartialEq)]
pub struct Mask {
    /// What the voxels of each class show, by its number.
    pub classes: Vec<Class>,
}

/// What the voxels of one class show.
#[derive(Debug, Clone, PartialEq)]
pub enum Class {
    /// What the scene's transfer function says.
    Shown,
    /// Nothing.
    Hidden,
    /// What this transfer function says in place of the scene's.
    Own(TransferFunction),
}

impl Mask {
    /// The transfer function of a class, `None` if it is hidden; `shown` is the scene's.
    pub fn function<'a>(&'a self, class: usize, shown: &'a TransferFunction) -> Option<&'a TransferFunction> {
        match self.classes.get(class) {
            None | Some(Class::Shown) => Some(shown),
            Some(Class::Hidden) => None,
            Some(Class::Own(own)) => Some(own),
        }
    }

    /// The transfer functions of the first `count` classes; that of a hidden one is 0 everywhere.
    pub fn functions(&self, count: usize, shown: &TransferFunction) -> Vec<TransferFunction> {
        (0..count).map(|class| self.function(class, shown).cloned().unwrap_or_else(|| shown.without_terms())).collect()
    }

    /// True if the voxels of a class are hidden.
    pub fn hides(&self, class: usize) -> bool {
        matches!(self.classes.get(class), Some(Class::Hidden))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transfer::{Curve, Knot, Optics, Term};

    #[test]
    fn a_class_without_an_entry_is_shown_and_a_hidden_one_shows_nothing() {
        let function = |s: f64| {
            let curve = Curve::new(vec![Knot { value: 0.0, optics: Optics::colored(s, [1.0; 3]) }]).expect("a curve");
            TransferFunction::new([-10.0, 10.0], 5.0, vec![Term { curve, weight: None }]).expect("a domain")
        };
        let mask = Mask { classes: vec![Class::Hidden, Class::Own(function(3.0)), Class::Shown] };
        let found = mask
            .functions(4, &function(1.0))
            .iter()
            .map(|f| f.evaluate(0.0, 0.0).extinction_per_mm)
            .collect::<Vec<_>>();
        assert_eq!(found, [0.0, 3.0, 1.0, 1.0]);
        assert_eq!([0, 1, 9].map(|class| mask.hides(class)), [true, false, false]);
    }
}
