//! How samples should lie in memory: in lines, or in bricks.
//!
//! `cargo bench --bench layout`. Registers whose lanes are rays take a sample every half voxel, as the kernels do: of a value, four pairs of
//! neighbours along x are read, each pair at once; of a gradient by central differences, four lines of four and eight pairs more. Bricks
//! store an apron, so that all of that lies in one brick; or one along x alone, so that pairs do; or none, and then each voxel is read by
//! itself. Rays are parallel and a voxel apart, in tiles of 16 x 16; one thread. All samples of a ray are taken, as fog asks for, or those
//! near surfaces, as skipping empty space leaves them. The layouts take turns, medians of the ratios of each turn; that they read the same
//! is checked.
#![allow(missing_docs, reason = "a program")]
#![allow(clippy::print_stdout, reason = "the table that it is for")]

#[cfg(target_arch = "x86_64")]
#[path = "layout/table.rs"]
mod table;

fn main() {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
        return table::print();
    }
    println!("Nothing to measure: this processor lacks AVX2.");
}
