//! What a stage reads of the volume, so that nobody computes what nobody reads.

/// What an effect, a classifier or an integrator reads. The plan takes the [union](Demand::union) over all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Demand {
    /// The gradient vector at samples, HU/mm: shading.
    pub gradient: bool,
    /// The gradient magnitude as a channel of its own, HU/mm: 2D transfer functions.
    pub gradient_magnitude: bool,
    /// Value ranges of blocks of cells: skipping of empty space.
    pub macrocells: bool,
    /// Transmittance towards directional lights at the voxels: shadows and scattering.
    pub visibility: bool,
}

impl Demand {
    /// What either of the two reads.
    #[must_use]
    pub fn union(self, other: Demand) -> Demand {
        Demand {
            gradient: self.gradient || other.gradient,
            gradient_magnitude: self.gradient_magnitude || other.gradient_magnitude,
            macrocells: self.macrocells || other.macrocells,
            visibility: self.visibility || other.visibility,
        }
    }
}
