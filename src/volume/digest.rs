//! Identity of a volume's values.

use sha2::{Digest, Sha256};

use super::{Samples, Volume};

/// Values that are hashed at once.
const CHUNK_VALUES: usize = 1 << 14;

impl Volume {
    /// SHA-256 over all values, x fastest, then y, then z, each as a little-endian f32 (0 for -0); lower-case
    /// hexadecimal.
    ///
    /// Of an RGBA volume all four stored components count, red first.
    ///
    /// It depends neither on how samples are stored nor on where the volume lies, so that other programs can compute it
    /// from the same file.
    pub fn values_sha256(&self) -> String {
        let mut hash = Sha256::new();
        let mut bytes = Vec::with_capacity(CHUNK_VALUES * size_of::<f32>());
        // Adding 0 makes one zero of the two, so that integers and floats agree.
        let value = |stored: f64| self.rescale.value(stored) as f32 + 0.0;
        // Of integers there are fewer than voxels.
        let values: Vec<f32> = match &self.samples {
            Samples::I16(_) => (i16::MIN..=i16::MAX).map(|stored| value(stored.into())).collect(),
            _ => Vec::new(),
        };
        for start in (0..self.samples.len()).step_by(CHUNK_VALUES) {
            bytes.clear();
            let chunk = start..self.samples.len().min(start + CHUNK_VALUES);
            let mut add = |value: f32| bytes.extend(value.to_le_bytes());
            match &self.samples {
                Samples::Rgba8(data) => data[chunk].as_flattened().iter().for_each(|&c| add(f32::from(c))),
                Samples::Rgba16(data) => data[chunk].as_flattened().iter().for_each(|&c| add(f32::from(c))),
                Samples::I16(data) => {
                    data[chunk].iter().for_each(|&v| add(values[usize::from((v as u16) ^ 0x8000)]));
                }
                Samples::F32(data) => data[chunk].iter().for_each(|&v| add(value(v.into()))),
            }
            hash.update(&bytes);
        }
        hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::volume::{Grid, Quantity, Rescale, Samples, Volume};

    #[test]
    fn the_hash_is_of_values_not_of_storage() {
        let grid = Grid::axis_aligned([2, 1, 1], DVec3::ONE).unwrap();
        let volume = |samples, rescale| Volume::new(grid, samples, rescale, Quantity::Hu).unwrap();
        let shifted = volume(Samples::I16(vec![0, 1]), Rescale { slope: 1.0, intercept: -1024.0 });
        let floats = volume(Samples::F32(vec![-1024.0, -1023.0]), Rescale::IDENTITY);
        // printf '\x00\x00\x80\xc4\x00\xc0\x7f\xc4' | sha256sum
        let expected = "a033227903711f8e0ad875c5101af1d7f9b797e06a91f8570c4b41491504d9d5";
        assert_eq!(shifted.values_sha256(), expected);
        assert_eq!(floats.values_sha256(), expected);
        let colors = volume(Samples::Rgba8(vec![[0, 1, 2, 3], [4, 5, 6, 7]]), Rescale::IDENTITY);
        // python3: sha256(struct.pack("<8f", *range(8)))
        let of_components = "0571cfe42be5c7b95de9afc7c7ba1286fb7a2ef10a9035f8d6b87d21a3bc8387";
        assert_eq!(colors.values_sha256(), of_components, "all components of a colour count");
        let other = volume(Samples::I16(vec![1, 0]), Rescale::IDENTITY);
        assert_ne!(other.values_sha256(), expected, "other values have another hash");
    }
}
