//! A scene: tissues, painted one over the other.

use glam::Vec3;

use super::sdf::{Ball, Range, Solid};
use super::tissue::{AIR_HU, Material, mix, smooth_step};

/// A solid and what it is made of, painted over everything that comes before it in the scene.
#[derive(Debug, Clone)]
pub(super) struct Tissue {
    solid: Solid,
    /// Depth beneath the solid's surface (mm) from which a material holds; the outermost first.
    coats: Vec<(f32, Material)>,
    /// How deep beneath the skin the solid is cut off, mm.
    beneath_skin_mm: Option<f32>,
    /// Which structure of the body it belongs to, from 1; 0 for none.
    structure: u8,
}

/// Tissues in the order in which they are painted.
#[derive(Debug, Clone)]
pub(super) struct Scene {
    /// The outer surface of the body, beneath which tissues may be cut off.
    pub(super) skin: Solid,
    pub(super) tissues: Vec<Tissue>,
    /// Half the width of the tissues' edges, mm.
    pub(super) edge_mm: f32,
}

impl Tissue {
    pub(super) fn new(material: Material, solid: Solid) -> Self {
        Tissue { solid, coats: vec![(0.0, material)], beneath_skin_mm: None, structure: 0 }
    }

    /// With another material from `depth_mm` inwards.
    pub(super) fn core(mut self, depth_mm: f32, material: Material) -> Self {
        self.coats.push((depth_mm, material));
        self
    }

    /// As a part of a structure, from 1.
    fn of_structure(mut self, structure: u8) -> Self {
        self.structure = structure;
        self
    }

    /// Cut off where it would come closer than `mm` to the surface of the skin.
    pub(super) fn beneath_skin(mut self, mm: f32) -> Self {
        self.beneath_skin_mm = Some(mm);
        self
    }
}

impl Scene {
    /// The tissues of structures, in the order in which they are painted; the first structure has number 1.
    pub(super) fn of_structures(skin: Solid, structures: impl IntoIterator<Item = Vec<Tissue>>, edge_mm: f32) -> Self {
        let numbered = structures.into_iter().zip(1..);
        let tissues =
            numbered.flat_map(|(tissues, structure)| tissues.into_iter().map(move |t| t.of_structure(structure)));
        Scene { skin, tissues: tissues.collect(), edge_mm }
    }

    /// Value at `p`, HU.
    pub(super) fn hu(&self, p: Vec3) -> f32 {
        let mut skin_mm = None;
        let mut hu = AIR_HU;
        for tissue in &self.tissues {
            let mut d = tissue.solid.distance(p);
            if let Some(mm) = tissue.beneath_skin_mm
                && d < self.edge_mm
            {
                d = d.max(*skin_mm.get_or_insert_with(|| self.skin.distance(p)) + mm);
            }
            for &(depth_mm, material) in &tissue.coats {
                if d + depth_mm < self.edge_mm {
                    let share = smooth_step(-self.edge_mm, self.edge_mm, -(d + depth_mm));
                    hu = mix(hu, material.hu(p, -d), share);
                }
            }
        }
        hu
    }

    /// The structure at `p`: that of the tissue painted last of those that have `p` inside; 0 outside of all.
    pub(super) fn structure(&self, p: Vec3) -> u8 {
        let mut skin_mm = None;
        let mut is_inside = |tissue: &&Tissue| {
            let mut beneath = |mm: f32| *skin_mm.get_or_insert_with(|| self.skin.distance(p)) + mm;
            tissue.solid.distance(p) < 0.0 && tissue.beneath_skin_mm.is_none_or(|mm| beneath(mm) < 0.0)
        };
        self.tissues.iter().rev().find(|tissue| is_inside(tissue)).map_or(0, |tissue| tissue.structure)
    }

    /// A scene with the same values in `ball`, without what cannot matter there.
    pub(super) fn near(&self, ball: Ball) -> Scene {
        let skin_mm = self.skin.range(ball);
        let mut tissues: Vec<Tissue> = Vec::new();
        for tissue in &self.tissues {
            let Some((tissue, covers)) = tissue.near(ball, skin_mm, self.edge_mm) else { continue };
            if covers {
                tissues.clear();
            }
            tissues.push(tissue);
        }
        let skin =
            if tissues.iter().any(|t| t.beneath_skin_mm.is_some()) { self.skin.near(ball) } else { Solid::Everywhere };
        Scene { skin, tissues, edge_mm: self.edge_mm }
    }
}

impl Tissue {
    /// The tissue in `ball`, if it is there at all, and whether it covers all of it.
    fn near(&self, ball: Ball, skin_mm: Range, edge_mm: f32) -> Option<(Tissue, bool)> {
        let own = self.solid.range(ball);
        if own.low >= edge_mm {
            return None;
        }
        let cut = self.beneath_skin_mm.map(|mm| Range { low: skin_mm.low + mm, high: skin_mm.high + mm });
        let all = cut.map_or(own, |cut| Range { low: own.low.max(cut.low), high: own.high.max(cut.high) });
        if all.low >= edge_mm {
            return None;
        }
        let beneath_skin_mm = self.beneath_skin_mm.filter(|_| cut.is_some_and(|cut| cut.high > own.low));

        let solidly = |depth_mm: f32| all.high + depth_mm <= -edge_mm;
        let outermost = self.coats.iter().rposition(|&(depth_mm, _)| solidly(depth_mm)).unwrap_or(0);
        let coats: Vec<_> = self.coats[outermost..].iter().copied().filter(|&(mm, _)| all.low + mm < edge_mm).collect();

        let covers = solidly(self.coats[0].0);
        let same_everywhere = match coats[..] {
            [(depth_mm, material)] => solidly(depth_mm) && -all.high >= material.varies_to_mm(),
            _ => false,
        };
        let tissue = if same_everywhere {
            Tissue { solid: Solid::Everywhere, coats, beneath_skin_mm: None, structure: self.structure }
        } else {
            Tissue { solid: self.solid.near(ball), coats, beneath_skin_mm, structure: self.structure }
        };
        Some((tissue, covers))
    }
}

#[cfg(test)]
mod tests {
    use super::super::anatomy;
    use super::super::noise::bell;
    use super::*;

    #[test]
    fn a_scene_cut_down_to_a_ball_has_the_same_values_there() {
        for (name, scene) in [("head", anatomy::head::head(1.2)), ("chest", anatomy::chest::chest(1.8))] {
            let mut tissues_left = 0;
            for index in 0..300 {
                let spread = |stream: u64| 45.0 * bell(stream, index);
                let ball = Ball { center: Vec3::new(spread(1), spread(2) - 10.0, spread(3)), radius_mm: 8.0 };
                let near = scene.near(ball);
                tissues_left += near.tissues.len();
                for step in 0..10_u64 {
                    let direction =
                        Vec3::new(bell(4, index * 10 + step), bell(5, index), bell(6, step)).normalize_or_zero();
                    let p = ball.center + ball.radius_mm * (step as f32 / 10.0) * direction;
                    let (expected, found) = (scene.hu(p), near.hu(p));
                    // Rounding differs where a solid is the whole of space in the ball.
                    assert!((expected - found).abs() < 0.1, "{name} at {p}: found {found} HU, expected {expected}");
                    assert_eq!(near.structure(p), scene.structure(p), "{name}: structure at {p}");
                }
            }
            let average = tissues_left as f32 / 300.0;
            let all = scene.tissues.len();
            assert!(average < 0.2 * all as f32, "{name}, tissues per ball: found {average} of {all}");
        }
    }
}
