//! How much error a ray may make, and how much it has made.

/// Shares of the tolerance: pieces by what they absorb, pieces by their length, the rest of a ray that is cut short,
/// and rounding.
const BY_ABSORPTION: f64 = 0.85;
const BY_LENGTH: f64 = 0.05;
const PIECES_AND_REST: f64 = 0.95;

/// The error account of one ray.
///
/// A piece with transmittance `T` in front of it that absorbs `A` adds `T · error`. The account allows, at any point of the
/// ray, `BY_ABSORPTION · tolerance · (1 − T)` plus `BY_LENGTH · tolerance ·` the fraction of the ray behind it; both grow
/// along the ray, the first to at most its share since `Σ T A = 1 − T_end ≤ 1`. What a piece leaves unspent later ones may
/// spend, and what pieces leave unspent the end of the ray may: a ray stops as soon as what is left of it cannot make the
/// total exceed the tolerance.
#[derive(Debug, Clone, Copy)]
pub(super) struct Budget {
    tolerance: f64,
    spent: f64,
}

impl Budget {
    pub(super) fn new(tolerance: f64) -> Self {
        Budget { tolerance, spent: 0.0 }
    }

    /// An account of which so much is spent.
    pub(super) fn resumed(tolerance: f64, spent: f64) -> Self {
        Budget { tolerance, spent }
    }

    /// What has been spent.
    pub(super) fn spent(&self) -> f64 {
        self.spent
    }

    /// What pieces and the rest of a ray that ends may cost together.
    pub(super) fn of_pieces_and_rest(tolerance: f64) -> f64 {
        PIECES_AND_REST * tolerance
    }

    /// What pieces may cost so that all of them together keep to the account: a share of what each absorbs, and one to be
    /// shared out by length.
    pub(super) fn of_pieces(tolerance: f64) -> [f64; 2] {
        [BY_ABSORPTION * tolerance, BY_LENGTH * tolerance]
    }

    /// What may still be spent by pieces up to a point with this transmittance, this fraction of the ray behind it.
    pub(super) fn left(&self, transmittance: f64, fraction: f64) -> f64 {
        self.tolerance * (BY_ABSORPTION * (1.0 - transmittance) + BY_LENGTH * fraction) - self.spent
    }

    pub(super) fn spend(&mut self, error: f64) {
        self.spent += error;
    }

    /// Whether a ray may end with an error of at most `rest`.
    pub(super) fn may_end(&self, rest: f64) -> bool {
        self.spent + rest <= Budget::of_pieces_and_rest(self.tolerance)
    }

    /// Bound on the error of the ray, if it ends with an error of at most `rest`; rounding included.
    pub(super) fn bound(&self, rest: f64) -> f64 {
        self.spent + rest + (1.0 - PIECES_AND_REST) * self.tolerance
    }
}
