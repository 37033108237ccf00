//! Planes of numbers and filters that act along rows and columns one after the other.

/// One number a pixel.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    pub(super) values: Vec<f64>,
    pub(super) width: usize,
}

/// Weights at -radius ..= radius.
#[derive(Clone, Debug)]
pub(super) struct Kernel(Vec<f64>);

impl Kernel {
    pub(super) fn new(radius: usize, weight: impl Fn(f64) -> f64) -> Kernel {
        Kernel((0..=2 * radius).map(|i| weight(i as f64 - radius as f64)).collect())
    }

    /// exp(-x^2 / 2 deviation^2), x in pixels.
    pub(super) fn gaussian(deviation: f64, radius: usize) -> Kernel {
        Kernel::new(radius, |x| libm::exp(-x * x / (2.0 * deviation * deviation)))
    }

    pub(super) fn sum(&self) -> f64 {
        self.0.iter().sum()
    }

    /// With the sum 1.
    pub(super) fn normalized(&self) -> Kernel {
        let sum = self.sum();
        Kernel(self.0.iter().map(|weight| weight / sum).collect())
    }

    /// Those above 0 with the sum 1, those below with the sum -1.
    pub(super) fn balanced(&self) -> Kernel {
        let positive: f64 = self.0.iter().filter(|weight| **weight > 0.0).sum();
        let negative: f64 = -self.0.iter().filter(|weight| **weight < 0.0).sum::<f64>();
        Kernel(self.0.iter().map(|w| if *w > 0.0 { w / positive } else { w / negative }).collect())
    }

    fn radius(&self) -> usize {
        self.0.len() / 2
    }
}

impl Plane {
    pub(super) fn new(values: Vec<f64>, width: usize) -> Plane {
        Plane { values, width }
    }

    /// Filtered along x and along y; beyond its border a plane goes on as it ends.
    pub(super) fn filtered(&self, along_x: &Kernel, along_y: &Kernel) -> Plane {
        self.rows(along_x).transposed().rows(along_y).transposed()
    }

    fn rows(&self, kernel: &Kernel) -> Plane {
        let radius = kernel.radius();
        let mut values = Vec::with_capacity(self.values.len());
        let mut padded = Vec::with_capacity(self.width + 2 * radius);
        for row in self.values.chunks_exact(self.width) {
            padded.clear();
            padded.extend(std::iter::repeat_n(row[0], radius));
            padded.extend_from_slice(row);
            padded.extend(std::iter::repeat_n(row[self.width - 1], radius));
            let at =
                |window: &[f64]| window.iter().zip(&kernel.0).map(|(value, weight)| value * weight).sum();
            values.extend(padded.windows(kernel.0.len()).map(at).take(self.width).collect::<Vec<f64>>());
        }
        Plane { values, width: self.width }
    }

    fn transposed(&self) -> Plane {
        let height = self.values.len() / self.width;
        let value = |i: usize| self.values[i % height * self.width + i / height];
        Plane { values: (0..self.values.len()).map(value).collect(), width: height }
    }
}
