//! Which samples of a ray are taken, once per frame.

use super::lattice::{Cuts, Stretch};
use super::whole_steps::WholeSteps;
use crate::field::Chord;
use crate::integrate::Frame;
use crate::plan::{March, Order, SampleRule};
use crate::scene::Ray;
use glam::DVec3;

/// Takes samples of rays.
pub(super) struct Sampling<'a> {
    frame: &'a Frame<'a>,
    settings: &'a March,
    rule: SampleRule,
    order: Order,
    /// View planes stand still when the camera moves along its line of sight.
    anchor_mm: DVec3,
    /// Where something is clipped and steps are whole.
    clipped: Option<WholeSteps>,
}

impl<'a> Sampling<'a> {
    /// Samples by the rule and in the order of the settings.
    pub(super) fn new(frame: &'a Frame<'a>, settings: &'a March) -> Self {
        let clips = settings.rule == SampleRule::WholeSteps && !frame.scene.effects.clip.half_spaces.is_empty();
        Sampling {
            frame,
            settings,
            rule: settings.rule,
            order: settings.order,
            anchor_mm: frame.volume.grid().center_mm(),
            clipped: clips.then(|| WholeSteps::new(frame.scene, frame.volume.grid())),
        }
    }

    /// Samples at both ends of all intervals, front to back, for what lies between them.
    pub(super) fn of_ends(frame: &'a Frame<'a>, settings: &'a March) -> Self {
        let (rule, order) = (SampleRule::Trapezoid, Order::FrontToBack);
        Sampling { rule, order, clipped: None, ..Sampling::new(frame, settings) }
    }

    /// Samples by the rule of the settings, front to back.
    pub(super) fn front_to_back(frame: &'a Frame<'a>, settings: &'a March) -> Self {
        Sampling { order: Order::FrontToBack, ..Sampling::new(frame, settings) }
    }

    /// The ray's way through what is shown, and its samples in the order they are visited; `None` if there is no way.
    #[inline(always)]
    pub(super) fn along(&self, ray: Ray, pixel: [usize; 2]) -> Option<(Chord, [Stretch; 4])> {
        let (grid, scene) = (self.frame.volume.grid(), self.frame.scene);
        self.along_chord(ray, pixel, || Chord::new(grid, &scene.effects.clip, ray))
    }

    /// The same of a ray whose chord is known.
    #[inline(always)]
    pub(super) fn along_chord(
        &self,
        ray: Ray,
        pixel: [usize; 2],
        chord: impl FnOnce() -> Option<Chord>,
    ) -> Option<(Chord, [Stretch; 4])> {
        let (grid, scene) = (self.frame.volume.grid(), self.frame.scene);
        let cuts = |chord: &Chord| Cuts::new(self.settings, chord, ray, scene.camera.forward(), self.anchor_mm, pixel);
        if let Some(clipped) = &self.clipped {
            let chord = clipped.chord(grid, ray)?;
            let samples = clipped.left(&chord, ray, cuts(&chord).whole_steps())?;
            return Some((chord, samples.in_order(self.order)));
        }
        let chord = chord()?;
        Some((chord, cuts(&chord).stretches(self.rule, self.order)))
    }
}
