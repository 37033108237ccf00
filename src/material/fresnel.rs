//! Reflection and refraction at a smooth interface of two dielectrics, in a form that stays accurate where their
//! refractive indices are nearly equal and at grazing angles.

/// An interface seen from the side from which light is followed: index n_i on this side, n_t beyond.
#[derive(Clone, Copy, Debug)]
pub struct Interface {
    /// m = n_i / n_t.
    ratio: f64,
    /// 1 - m^2, with the accuracy of the ratio that was given even if that is near 1.
    contrast: f64,
}

/// What happens at one angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fresnel {
    /// Reflected share of unpolarised light, in 0..1.
    pub reflectance: f64,
    /// Cosine of the refracted direction with the normal beyond; none for total internal reflection.
    pub cos_transmitted: Option<f64>,
}

impl Interface {
    /// The interface of a closed object, from `ratio` = n outside / n inside > 0 and whether light is followed
    /// from the outside in.
    #[inline]
    pub fn new(ratio: f64, entering: bool) -> Interface {
        match entering {
            true => Interface { ratio, contrast: (1.0 - ratio) * (1.0 + ratio) },
            false => {
                Interface { ratio: 1.0 / ratio, contrast: ((ratio - 1.0) / ratio) * ((ratio + 1.0) / ratio) }
            }
        }
    }

    /// n_i / n_t.
    pub fn ratio(&self) -> f64 {
        self.ratio
    }

    /// 1 - (n_i / n_t)^2.
    pub fn contrast(&self) -> f64 {
        self.contrast
    }

    /// The exact Fresnel equations at the cosine `cos` in (0, 1] of the incoming direction.
    ///
    /// With m = n_i / n_t and t the cosine beyond, the usual (cos - t / m) / (cos + t / m) and its like cancel
    /// for m near 1. Their numerators times sums are 1 - m^2 times a factor; this divides by the squared sums.
    #[inline]
    pub fn at(&self, cos: f64) -> Fresnel {
        let (m, contrast) = (self.ratio, self.contrast);
        if contrast == 0.0 {
            return Fresnel { reflectance: 0.0, cos_transmitted: Some(cos) };
        }
        let squared = contrast + m * m * cos * cos;
        // Not a number if a ratio is so extreme that it overflows: then there is no way out either.
        if squared.is_nan() || squared <= 0.0 {
            return Fresnel { reflectance: 1.0, cos_transmitted: None };
        }
        let t = squared.sqrt();
        let (sum_s, sum_p) = (m * cos + t, cos + m * t);
        let r_s = contrast / (sum_s * sum_s);
        let r_p = contrast * (cos * cos * (1.0 + m * m) - m * m) / (sum_p * sum_p);
        Fresnel { reflectance: (0.5 * (r_s * r_s + r_p * r_p)).min(1.0), cos_transmitted: Some(t) }
    }
}
