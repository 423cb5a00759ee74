//! One body over all kernels: the registers of any level, any threads and tiles, with and without leaps give the same bits, and
//! so does the kernel that takes one sample after the other.

use glam::DVec3;
use pellucid::integrate::{Rendered, Schedule, render_scheduled};
use pellucid::oracle::Oracle;
use pellucid::plan::{Emission, Lattice, March, Method, Order, SampleRule};
use pellucid::scene::{Scene, Shading};
use pellucid::simd::Level;
use pellucid::transfer::{Curve, Knot, Optics, Term, TransferFunction};
use pellucid::volume::{Grid, Quantity, Rescale, Samples, Slices, Volume};

use super::scenes::{MARCH, apart, blobs_f32, blobs_i16, scene, tissue_1d, tissue_2d, two_lights};

fn rendered(volume: &Volume, scene: &Scene, settings: March, schedule: Schedule) -> Rendered {
    render_scheduled(volume, scene, &Method::March(settings), schedule, &|_| ()).unwrap()
}

fn bits(rendered: &Rendered) -> Vec<u32> {
    rendered.image.pixels().iter().flatten().map(|x| x.to_bits()).collect()
}

fn available() -> impl Iterator<Item = Level> {
    Level::ALL.into_iter().filter(|level| level.is_available())
}

/// A curve of so many knots, every other one dark.
fn comb(knots: usize) -> TransferFunction {
    let knot = |i: usize| Knot {
        value: -900.0 + 2400.0 * i as f64 / knots as f64,
        optics: Optics::colored([0.0, 0.0, 0.3, 0.6][i % 4], [0.9, 0.5, 0.1 * (i % 7) as f64]),
    };
    let curve = Curve::new((0..knots).map(knot).collect()).unwrap();
    TransferFunction::new([-1024.0, 3071.0], 500.0, vec![Term { curve, weight: None }]).unwrap()
}

fn shadings() -> [Option<Shading>; 4] {
    let one_sided = Shading { two_sided: false, soft_gradient_per_mm: 0.0, shininess: 17.5, ..two_lights() };
    [None, Some(two_lights()), Some(one_sided), Some(Shading { shininess: 3.3, ..two_lights() })]
}

#[test]
fn every_level_gives_the_same_bits() {
    for (volume, voxel) in [(blobs_i16(), "i16"), (blobs_f32(), "f32")] {
        for function in [tissue_1d(), tissue_2d(), comb(17), comb(100)] {
            for shading in shadings() {
                let scene = scene(&volume, function.clone(), shading);
                for settings in [
                    MARCH,
                    March { step_mm: 0.07, termination_transmittance: 1e-3, ..MARCH },
                    March { rule: SampleRule::Trapezoid, order: Order::BackToFront, ..MARCH },
                    March { rule: SampleRule::Left, emission: Emission::PerSample, step_mm: 3.0, ..MARCH },
                ] {
                    let expected =
                        rendered(&volume, &scene, settings, Schedule { level: Level::Scalar, ..Schedule::default() });
                    for level in available() {
                        let all = Schedule { level, empty_space_skipping: false, ..Schedule::default() };
                        let found = rendered(&volume, &scene, settings, all);
                        let kernel = &found.statistics.kernel;
                        assert!(kernel.contains(voxel) && kernel.ends_with(&level.to_string()), "found {kernel}");
                        assert!(bits(&found) == bits(&expected), "{kernel}: other bits with {settings:?}");
                        let found = rendered(&volume, &scene, settings, Schedule { level, ..Schedule::default() });
                        assert!(bits(&found) == bits(&expected), "{kernel}: other bits after leaps, {settings:?}");
                        assert_eq!(found.statistics.samples, expected.statistics.samples, "{kernel}");
                    }
                }
            }
        }
    }
}

#[test]
fn threads_and_tiles_do_not_matter_at_any_level() {
    let volume = blobs_i16();
    let scene = scene(&volume, tissue_2d(), Some(two_lights()));
    let expected = bits(&rendered(&volume, &scene, MARCH, Schedule { level: Level::Scalar, ..Schedule::default() }));
    for level in available() {
        for threads in [1, 2, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let schedule = Schedule { level, shuffled_tiles: Some(threads as u64), ..Schedule::default() };
            let found = pool.install(|| rendered(&volume, &scene, MARCH, schedule));
            assert!(bits(&found) == expected, "{level}, {threads} threads");
        }
    }
}

/// Noise on a small lattice: borders everywhere.
fn noise(dims: [usize; 3]) -> Volume {
    let grid = Grid::axis_aligned(dims, DVec3::new(0.7, 1.1, 1.6)).unwrap();
    let stored = (0..grid.voxel_count()).map(|i| ((i * 7919) % 2500) as i16 - 1000).collect();
    Volume::new(grid, Samples::I16(stored), Rescale::IDENTITY, Quantity::Hu).unwrap()
}

#[test]
fn many_samples_at_a_time_are_one_after_the_other() {
    for dims in [[2, 2, 2], [3, 5, 4], [7, 2, 9], [12, 11, 13]] {
        let volume = noise(dims);
        // Even slices as a table: the kernel for uneven ones, whose arithmetic is that of one sample at a time.
        let places: Vec<f64> = (0..dims[2]).map(|k| k as f64).collect();
        let table = volume.clone().with_slices(Slices::new(&places).unwrap()).unwrap();
        for shading in shadings() {
            let scene = scene(&volume, tissue_1d(), shading);
            let many = rendered(&volume, &scene, MARCH, Schedule::default());
            let one = rendered(&table, &scene, MARCH, Schedule::default());
            assert!(one.statistics.kernel.ends_with("scalar"), "found {}", one.statistics.kernel);
            let worst = apart(many.image.pixels(), one.image.pixels());
            assert!(worst < 1e-6, "{dims:?}: {worst:e} from one sample after the other");
        }
    }
}

#[test]
fn fine_steps_see_what_the_oracle_sees() {
    let volume = noise([6, 5, 4]);
    for (function, shading) in [(tissue_1d(), None), (tissue_1d(), Some(two_lights())), (tissue_2d(), None)] {
        let mut scene = scene(&volume, function, shading);
        scene.camera = scene.camera.with_size([13, 11]);
        let truth = Oracle::new(&volume, &scene).render(|_| ());
        for level in available() {
            let schedule = Schedule { level, ..Schedule::default() };
            let fine = rendered(&volume, &scene, March { step_mm: 0.004, ..MARCH }, schedule);
            let worst = apart(fine.image.pixels(), &truth);
            assert!(worst < 1e-4, "{level}: {worst:e} from the oracle");
        }
    }
}

#[test]
fn steps_too_long_for_registers_are_taken_one_by_one() {
    let volume = blobs_i16();
    let scene = scene(&volume, tissue_1d(), None);
    for (settings, by_lanes) in [
        (March { step_mm: 1.0, ..MARCH }, true),
        (March { step_mm: 50.0, ..MARCH }, false),
        (March { lattice: Lattice::ViewPlanes, ..MARCH }, false),
    ] {
        let kernel = rendered(&volume, &scene, settings, Schedule::default()).statistics.kernel;
        let level = if by_lanes { Level::widest() } else { Level::Scalar };
        assert!(kernel.ends_with(&level.to_string()), "{settings:?}: found {kernel}");
    }
}
