//! Linear attenuation of X-rays from CT numbers: what a radiograph of the scanned patient would measure.
//!
//! **Definition.** A CT number is a linear attenuation coefficient at the effective energy `E_s` of the scan, relative to
//! water and air (Kalender 2011, sec. 1.2.2):
//!
//! ```text
//! HU = 1000 · (μ(E_s) − μ_water(E_s)) / (μ_water(E_s) − μ_air(E_s))
//! ```
//!
//! so air is at −1000, water at 0, and cortical bone at the number `HU_bone(E_s)` that this formula gives. At another
//! energy `E` the coefficient of a mixture of neighbouring two of the three is linear in HU, since both HU and `μ` are
//! linear in the volume fractions. `μ(HU)` is therefore piecewise linear through
//!
//! ```text
//! (−1000, μ_air(E)),   (0, μ_water(E)),   (HU_bone(E_s), μ_bone(E))
//! ```
//!
//! continued above with the slope between water and bone, and constant below −1000, where there is nothing left that could
//! attenuate less. This is the bilinear conversion of PET/CT attenuation correction (Burger et al. 2002; Carney, Townsend,
//! Rappoport and Bendriem 2006). At `E = E_s` it is the straight line that defines HU. Other materials (metal, iodine) are
//! taken for dense bone.
//!
//! **Source.** `μ = ρ · (μ/ρ)`, with the mass attenuation coefficients with coherent scattering of Hubbell and Seltzer,
//! *Tables of X-Ray Mass Attenuation Coefficients* (NISTIR 5632, 1995), table 4, for dry air near sea level, liquid water
//! and cortical bone (ICRU 44), interpolated linearly in the logarithms of energy and coefficient. None of the three has an
//! absorption edge in the range.

use super::{Curve, Knot, Optics};
use crate::error::{Error, Fault, Result};

/// Photon energies that the tables cover, keV.
pub const ENERGIES_KEV: [f64; 2] = [10.0, 200.0];

/// A material of which densities and coefficients are tabulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Material {
    /// Dry, near sea level: 1.205e-3 g/cm³.
    Air,
    /// Liquid: 1 g/cm³.
    Water,
    /// ICRU 44: 1.92 g/cm³.
    CorticalBone,
}

/// From CT numbers to linear attenuation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attenuation {
    /// Photon energy of the radiograph, keV.
    pub kev: f64,
    /// Effective photon energy of the scan, keV: about 70 for a tube at 120 kVp.
    pub scanned_at_kev: f64,
}

/// Energies of the tables, keV.
const TABLE_KEV: [f64; 11] = [10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0, 100.0, 150.0, 200.0];

impl Material {
    fn density_g_per_cm3(self) -> f64 {
        match self {
            Material::Air => 1.205e-3,
            Material::Water => 1.0,
            Material::CorticalBone => 1.92,
        }
    }

    /// `μ/ρ` at the energies of the tables, cm²/g.
    fn mass_attenuation_cm2_per_g(self) -> [f64; 11] {
        match self {
            Material::Air => [5.120, 1.614, 0.7779, 0.3538, 0.2485, 0.2080, 0.1875, 0.1662, 0.1541, 0.1356, 0.1233],
            Material::Water => [5.329, 1.673, 0.8096, 0.3756, 0.2683, 0.2269, 0.2059, 0.1837, 0.1707, 0.1505, 0.1370],
            Material::CorticalBone => {
                [28.51, 9.032, 4.001, 1.331, 0.6655, 0.4242, 0.3148, 0.2229, 0.1855, 0.1480, 0.1309]
            }
        }
    }

    /// `μ` at a photon energy within [`ENERGIES_KEV`], 1/mm.
    pub fn attenuation_per_mm(self, kev: f64) -> f64 {
        let last = TABLE_KEV.len() - 1;
        let i = TABLE_KEV.partition_point(|&e| e <= kev).clamp(1, last) - 1;
        let table = self.mass_attenuation_cm2_per_g();
        let share = (kev / TABLE_KEV[i]).ln() / (TABLE_KEV[i + 1] / TABLE_KEV[i]).ln();
        let mass = table[i] * (table[i + 1] / table[i]).powf(share);
        0.1 * self.density_g_per_cm3() * mass
    }
}

/// Beyond every CT number; the slope above bone is continued to here.
const FAR_HU: f64 = 1e6;

impl Attenuation {
    /// The CT number of cortical bone at the energy of the scan, HU.
    pub fn bone_hu(&self) -> f64 {
        let [air, water, bone] = [Material::Air, Material::Water, Material::CorticalBone]
            .map(|material| material.attenuation_per_mm(self.scanned_at_kev));
        1000.0 * (bone - water) / (water - air)
    }

    /// `μ` over HU as extinction, 1/mm, without any emission.
    ///
    /// # Errors
    /// `Fault::Spec` for an energy beyond the tables.
    pub fn curve(&self) -> Result<Curve> {
        let [low, high] = ENERGIES_KEV;
        if let Some(kev) = [self.kev, self.scanned_at_kev].into_iter().find(|kev| !(low..=high).contains(kev)) {
            return Err(Error::new(Fault::Spec, "no attenuation is tabulated for this photon energy")
                .found(format!("{kev} keV"))
                .expected(format!("{low} to {high} keV")));
        }
        let [air, water, bone] = [Material::Air, Material::Water, Material::CorticalBone]
            .map(|material| material.attenuation_per_mm(self.kev));
        let bone_hu = self.bone_hu();
        let far = water + (bone - water) * (FAR_HU / bone_hu);
        let knot = |(value, extinction_per_mm)| Knot { value, optics: Optics { extinction_per_mm, ..Optics::NOTHING } };
        Curve::new([(-1000.0, air), (0.0, water), (bone_hu, bone), (FAR_HU, far)].map(knot).to_vec())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transfer::Side;

    fn at(attenuation: Attenuation, hu: f64) -> f64 {
        attenuation.curve().expect("a tabulated energy").at(hu, Side::Right).extinction_per_mm
    }

    #[test]
    fn tabulated_energies_give_the_tables() {
        for (material, kev, per_cm) in [
            (Material::Water, 60.0, 0.2059),
            (Material::Water, 10.0, 5.329),
            (Material::Water, 200.0, 0.1370),
            (Material::CorticalBone, 100.0, 1.92 * 0.1855),
            (Material::Air, 80.0, 1.205e-3 * 0.1662),
        ] {
            let found = 10.0 * material.attenuation_per_mm(kev);
            assert!(
                (found / per_cm - 1.0).abs() < 1e-12,
                "{material:?} at {kev} keV: {found}, expected {per_cm} per cm"
            );
        }
    }

    #[test]
    fn between_tabulated_energies_it_is_a_power_law() {
        let [low, middle, high] = [60.0, 4800f64.sqrt(), 80.0].map(|e| Material::Water.attenuation_per_mm(e));
        let expected = (low * high).sqrt();
        assert!((middle / expected - 1.0).abs() < 1e-12, "found {middle}, expected {expected}");
        for material in [Material::Air, Material::Water, Material::CorticalBone] {
            let all: Vec<f64> = (20..=400).map(|e| material.attenuation_per_mm(0.5 * f64::from(e))).collect();
            assert!(all.windows(2).all(|w| w[0] > w[1]), "{material:?} attenuates less at higher energies");
        }
    }

    #[test]
    fn at_the_energy_of_the_scan_it_is_the_line_that_defines_hu() {
        let attenuation = Attenuation { kev: 70.0, scanned_at_kev: 70.0 };
        let [air, water] = [Material::Air, Material::Water].map(|m| m.attenuation_per_mm(70.0));
        for hu in [-1000.0, -400.0, 0.0, 35.0, 800.0, 1500.0, 3071.0] {
            let expected = water + (water - air) * hu / 1000.0;
            let found = at(attenuation, hu);
            assert!((found - expected).abs() < 1e-15, "{hu} HU: found {found}, expected {expected} per mm");
        }
        assert_eq!(at(attenuation, -1024.0), at(attenuation, -1000.0), "less than air there is not");
    }

    #[test]
    fn bone_gains_on_water_as_the_energy_falls() {
        let ratio = |kev| {
            let attenuation = Attenuation { kev, scanned_at_kev: 70.0 };
            at(attenuation, attenuation.bone_hu()) / at(attenuation, 0.0)
        };
        assert!((ratio(60.0) - 1.92 * 0.3148 / 0.2059).abs() < 1e-12, "found {}", ratio(60.0));
        assert!(ratio(40.0) > ratio(60.0) && ratio(60.0) > ratio(100.0));
        let bone_hu = Attenuation { kev: 60.0, scanned_at_kev: 70.0 }.bone_hu();
        assert!((1500.0..1700.0).contains(&bone_hu), "cortical bone at 120 kVp is at about 1600 HU, found {bone_hu}");
    }

    #[test]
    fn energies_beyond_the_tables_are_refused() {
        for (kev, scanned_at_kev) in [(9.9, 70.0), (60.0, 201.0), (f64::NAN, 70.0)] {
            let error = Attenuation { kev, scanned_at_kev }.curve().expect_err("not tabulated");
            assert_eq!(error.fault(), Fault::Spec, "{error}");
        }
    }
}
