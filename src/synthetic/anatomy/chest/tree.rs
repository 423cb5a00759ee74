//! Trees of vessels and airways: each branch divides into two, thinner and shorter, until it meets the surface of the lung.

use glam::Vec3;

use crate::synthetic::noise::bell;
use crate::synthetic::sdf::{Node, Segment, Solid, rod};

/// Where a tree enters the lung, how thick it is there, and where it goes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Root {
    from: Node,
    towards: (f32, f32, f32),
}

impl Root {
    pub(super) const fn new(from: Node, towards: (f32, f32, f32)) -> Self {
        Root { from, towards }
    }
}

/// A branch that is to grow.
struct Bud {
    at: Vec3,
    towards: Vec3,
    /// Across the branch: its children part to this side and to the other.
    aside: Vec3,
    radius_mm: f32,
    length_mm: f32,
    /// 1 for the root's, then 2 and 3 for its children, and so on: what its noise depends on.
    number: u64,
}

/// How much thinner and shorter a child is: a little wider than Murray's law has it (0.79), since small twigs are left out.
const THINNER: f32 = 0.80;
const SHORTER: f32 = 0.86;
/// Twigs thinner than this are not drawn, mm.
const THINNEST_MM: f32 = 0.7;
/// How far from the surface of the lung they end, mm.
const MARGIN_MM: f32 = 3.0;

/// The branches of a tree in a lung, of so many generations at most; each with all that grows from it in the third
/// generation, so that far ones are skipped.
pub(super) fn grown_from(root: &Root, seed: u64, lung: &Solid, generations: u32) -> Vec<Solid> {
    let (x, y, z, radius_mm) = root.from;
    let towards = Vec3::from(root.towards).normalize();
    let aside = towards.cross(Vec3::new(0.3, 0.8, 0.5)).normalize();
    let bud = Bud { at: Vec3::new(x, y, z), towards, aside, radius_mm, length_mm: 24.0, number: 1 };
    let mut branches = Vec::new();
    grow(&bud, seed, lung, 1 << generations, &mut branches);
    let subtree = |number: u64| number >> (number.ilog2().saturating_sub(3));
    let mut numbers: Vec<u64> = branches.iter().map(|&(number, _)| subtree(number)).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let solid = |subtree_number: u64| {
        let own = branches.iter().filter(|&&(number, _)| subtree(number) == subtree_number);
        Solid::Tube(own.flat_map(|(_, nodes)| segments(nodes)).collect())
    };
    numbers.into_iter().map(solid).collect()
}

fn segments(nodes: &[Node; 2]) -> Vec<Segment> {
    match rod(nodes) {
        Solid::Tube(segments) => segments,
        _ => unreachable!("a rod is a tube"),
    }
}

fn grow(bud: &Bud, seed: u64, lung: &Solid, end_number: u64, branches: &mut Vec<(u64, [Node; 2])>) {
    if bud.number >= end_number || bud.radius_mm < THINNEST_MM {
        return;
    }
    let noise = |stream: u64| bell(seed, 8 * bud.number + stream);
    // A branch that would leave the lung is shorter, or is not there.
    let fits = |length_mm: &f32| lung.distance(bud.at + *length_mm * bud.towards) < -MARGIN_MM - bud.radius_mm;
    let lengths = [1.0, 0.7, 0.4].map(|share| share * bud.length_mm * (1.0 + 0.12 * noise(0)));
    let Some(length_mm) = lengths.into_iter().find(fits) else { return };
    let end = bud.at + length_mm * bud.towards;
    let thin = THINNER * bud.radius_mm;
    branches.push((bud.number, [(bud.at.x, bud.at.y, bud.at.z, bud.radius_mm), (end.x, end.y, end.z, thin)]));
    // The next fork is across this one, more or less.
    let across = bud.towards.cross(bud.aside).normalize();
    for (child, side) in [(0, 1.0), (1, -1.0)] {
        let lean = side * (0.62 + 0.12 * noise(1 + child));
        let towards = (bud.towards + lean * bud.aside + 0.2 * noise(3 + child) * across).normalize();
        let aside = (across + 0.4 * noise(5) * bud.aside).normalize();
        let aside = (aside - aside.dot(towards) * towards).normalize();
        let child = Bud {
            at: end,
            towards,
            aside,
            radius_mm: thin,
            length_mm: SHORTER * bud.length_mm,
            number: 2 * bud.number + child,
        };
        grow(&child, seed, lung, end_number, branches);
    }
}
