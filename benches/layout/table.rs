//! Times of all layouts.

mod rays;
mod registers;
mod volume;

use std::time::Instant;

use rays::Picture;
use volume::{LAYOUTS, Laid, Measured};

/// 73 MB, and the largest that is measured elsewhere.
const VOLUMES: [[usize; 3]; 2] = [[512, 512, 140], [512, 512, 512]];

/// Directions of rays, in voxels: along the axes, and across all.
const VIEWS: [(&str, [f64; 3]); 4] = [
    ("along x", [1.0, 0.02, 0.03]),
    ("along y", [0.03, 1.0, 0.02]),
    ("along z", [0.02, 0.03, 1.0]),
    ("oblique", [0.62, 0.55, 0.56]),
];

/// All samples, or those near surfaces; and of how many rows of tiles one is taken, for the time it takes.
const PATTERNS: [(&str, bool, usize); 2] = [("all", false, 8), ("surface", true, 2)];

const TURNS: usize = 5;

/// What a picture may take, times the samples and besides, bytes.
const PROMISED: (f64, f64) = (1.3, 64e6);

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn row(name: &str, cells: impl Iterator<Item = String>) {
    println!("| {name} | {} |", cells.collect::<Vec<_>>().join(" | "));
}

/// Times of all layouts in turns, as a row of the table; the ratios.
fn measured(name: &str, layouts: &[Box<dyn Measured>], picture: &Picture) -> Vec<f64> {
    let (mut times, mut sums) = (vec![Vec::new(); layouts.len()], vec![0.0; layouts.len()]);
    for _ in 0..TURNS {
        for (n, laid) in layouts.iter().enumerate() {
            let start = Instant::now();
            sums[n] = laid.sum(picture);
            times[n].push(start.elapsed().as_secs_f64() * 1e9 / picture.samples());
        }
    }
    assert!(sums.iter().all(|&sum| sum == sums[0]), "another layout, other samples: {sums:?}");
    let ratio = |times: &Vec<f64>, lines: &Vec<f64>| median(times.iter().zip(lines).map(|(t, l)| t / l).collect());
    let ratios: Vec<f64> = times.iter().map(|of| ratio(of, &times[0])).collect();
    row(name, times.iter().zip(&ratios).map(|(of, ratio)| format!("{:.2} ({ratio:.2})", median(of.clone()))));
    ratios
}

/// All rows of a volume and of what is read; those that sum them up.
fn table<const LIT: bool>(dims: [usize; 3]) -> Vec<(String, Vec<f64>)> {
    let layouts: [Box<dyn Measured>; LAYOUTS.len()] = [
        Box::new(Laid::<0, LIT>::new(dims)),
        Box::new(Laid::<1, LIT>::new(dims)),
        Box::new(Laid::<2, LIT>::new(dims)),
        Box::new(Laid::<3, LIT>::new(dims)),
        Box::new(Laid::<4, LIT>::new(dims)),
        Box::new(Laid::<5, LIT>::new(dims)),
    ];
    let [nx, ny, nz] = dims;
    let what = format!("{nx} x {ny} x {nz}, {}", if LIT { "value and gradient" } else { "value" });
    let promised = PROMISED.0 + PROMISED.1 / (2 * dims.iter().product::<usize>()) as f64;
    let memory = layouts.iter().enumerate().map(|(n, laid)| match laid.memory() {
        memory if memory > promised => format!("{memory:.2} x, too much"),
        memory if n > 0 && memory + 1.0 > promised => format!("{memory:.2} x, not beside lines"),
        memory => format!("{memory:.2} x"),
    });
    row(&format!("{what}: memory, of {promised:.2} x"), memory);
    let mut sums = Vec::new();
    for (pattern, near, every) in PATTERNS {
        let mut logarithms = vec![0.0; LAYOUTS.len()];
        for (view, direction) in VIEWS {
            let picture = Picture::new(dims, direction, near, every);
            let ratios = measured(&format!("{what}, {pattern}, {view}"), &layouts, &picture);
            for (sum, ratio) in logarithms.iter_mut().zip(ratios) {
                *sum += ratio.ln() / VIEWS.len() as f64;
            }
        }
        sums.push((format!("{what}, {pattern}"), logarithms.iter().map(|sum| sum.exp()).collect()));
    }
    sums
}

/// Prints a row for each picture, and one for each pattern.
pub(crate) fn print() {
    let header = |first: &str| {
        row(first, LAYOUTS.iter().map(|layout| layout.name.to_owned()));
        println!("| --- |{}", " --: |".repeat(LAYOUTS.len()));
    };
    header("ns per sample (of lines)");
    let mut sums = Vec::new();
    for dims in VOLUMES {
        sums.extend(table::<false>(dims));
        sums.extend(table::<true>(dims));
    }
    println!();
    header("of lines, mean of views");
    for (name, ratios) in sums {
        row(&name, ratios.iter().map(|ratio| format!("{ratio:.2}")));
    }
    let (times, besides) = (PROMISED.0, PROMISED.1 / 1e6);
    println!();
    println!(
        "Memory: a picture may take {times} x its samples and {besides} MB, all in all. What is too much beside lines"
    );
    println!("would have to be made from them slab by slab, while they are read and freed.");
}
