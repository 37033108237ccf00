//! Statistical tests. Seeds are fixed, so a verdict is always the same; the significance says how likely a right
//! program would have been to fail when its test was written.

/// The significance of a whole test; [`sidak`] divides it among its parts.
pub(crate) const SIGNIFICANCE: f64 = 0.01;

/// The significance of each of `tests` independent tests that together have `significance` (Sidak 1967).
pub(crate) fn sidak(significance: f64, tests: usize) -> f64 {
    -libm::expm1(libm::log1p(-significance) / tests as f64)
}

/// The least expectation of a cell for which a chi-square statistic is close to its distribution.
const MIN_EXPECTED: f64 = 5.0;

/// Probability of a chi-square statistic at least as large as that of `observed` against `expected` counts, whose
/// totals agree. Cells expected to hold less than 5 are pooled; a count in a cell expected to be empty gives 0.
pub(crate) fn chi_square(observed: &[u64], expected: &[f64]) -> f64 {
    assert_eq!(observed.len(), expected.len());
    let mut cells: Vec<(f64, f64)> = expected.iter().zip(observed).map(|(&e, &o)| (e, o as f64)).collect();
    if cells.iter().any(|&(expected, observed)| expected == 0.0 && observed > 0.0) {
        return 0.0;
    }
    cells.sort_by(|a, b| a.0.total_cmp(&b.0));

    let (mut statistic, mut count) = (0.0, 0);
    let mut pool = (0.0, 0.0);
    for (i, &(expected, observed)) in cells.iter().enumerate() {
        pool = (pool.0 + expected, pool.1 + observed);
        let next_is_large = cells.get(i + 1).is_none_or(|next| next.0 >= MIN_EXPECTED);
        if pool.0 >= MIN_EXPECTED && next_is_large {
            statistic += (pool.1 - pool.0) * (pool.1 - pool.0) / pool.0;
            count += 1;
            pool = (0.0, 0.0);
        }
    }
    assert!(count > 1, "too few samples for a chi-square test");
    chi_square_tail(statistic, count - 1)
}

/// Probability that a chi-square variable of `degrees` degrees of freedom exceeds `statistic`.
pub(crate) fn chi_square_tail(statistic: f64, degrees: usize) -> f64 {
    upper_gamma(0.5 * degrees as f64, 0.5 * statistic)
}

/// [`chi_square`] for cells of equal probability.
pub(crate) fn chi_square_uniform(observed: &[u64]) -> f64 {
    let total: u64 = observed.iter().sum();
    chi_square(observed, &vec![total as f64 / observed.len() as f64; observed.len()])
}

/// The regularised upper incomplete gamma function Q(a, x): series below the mean, continued fraction above
/// (Abramowitz and Stegun 6.5.29, 6.5.31, the latter evaluated by Lentz's method).
fn upper_gamma(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    let factor = libm::exp(a * libm::log(x) - x - libm::lgamma(a));
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-16 {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        return 1.0 - factor * sum;
    }
    let mut b = x + 1.0 - a;
    let (mut c, mut d) = (1e300, 1.0 / b);
    let mut fraction = d;
    for i in 1..100_000 {
        let numerator = -f64::from(i) * (f64::from(i) - a);
        b += 2.0;
        d = 1.0 / (numerator * d + b);
        c = b + numerator / c;
        fraction *= c * d;
        if (c * d - 1.0).abs() < 1e-15 {
            break;
        }
    }
    factor * fraction
}

/// Probability that a normal variable is at least |z| away from its mean.
pub(crate) fn two_sided_tail(z: f64) -> f64 {
    libm::erfc(z.abs() * std::f64::consts::FRAC_1_SQRT_2)
}

/// Count, mean and spread of a sample (Welford 1962).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Moments {
    count: u64,
    mean: f64,
    squares: f64,
}

impl Moments {
    pub(crate) fn add(&mut self, x: f64) {
        self.count += 1;
        let before = x - self.mean;
        self.mean += before / self.count as f64;
        self.squares += before * (x - self.mean);
    }

    pub(crate) fn of(values: impl IntoIterator<Item = f64>) -> Moments {
        let mut moments = Moments::default();
        values.into_iter().for_each(|x| moments.add(x));
        moments
    }

    /// Of both samples together (Chan, Golub, LeVeque 1979).
    pub(crate) fn with(self, other: Moments) -> Moments {
        let count = self.count + other.count;
        if count == 0 {
            return self;
        }
        let (share, apart) = (other.count as f64 / count as f64, other.mean - self.mean);
        let between = apart * apart * share * self.count as f64;
        Moments { count, mean: self.mean + apart * share, squares: self.squares + other.squares + between }
    }

    pub(crate) fn mean(&self) -> f64 {
        self.mean
    }

    /// The unbiased estimate of the variance of one value.
    pub(crate) fn variance(&self) -> f64 {
        self.squares / (self.count - 1) as f64
    }

    /// Of the mean.
    pub(crate) fn standard_error(&self) -> f64 {
        (self.variance() / self.count as f64).sqrt()
    }

    /// Probability of a mean at least this far from `expected` if that were the true mean.
    pub(crate) fn p_value(&self, expected: f64) -> f64 {
        if self.mean == expected {
            return 1.0;
        }
        two_sided_tail((self.mean - expected) / self.standard_error())
    }
}

#[test]
fn chi_square_tail_agrees_with_tables() {
    // Quantiles of the chi-square distribution, NIST/SEMATECH e-Handbook of Statistical Methods 1.3.6.7.4,
    // which gives three decimals: half a unit of the last one moves the tail by less than 1e-4 of itself x 3.
    for (degrees, quantile, tail) in [
        (1, 3.841, 0.05),
        (1, 10.828, 0.001),
        (10, 18.307, 0.05),
        (10, 4.865, 0.90),
        (100, 124.342, 0.05),
        (100, 149.449, 0.001),
        (100, 70.065, 0.99),
    ] {
        let p = chi_square_tail(quantile, degrees);
        assert!((p / tail - 1.0).abs() < 3e-4, "{degrees} {quantile}: {p} instead of {tail}");
    }
    // Far above 100 degrees the cube root is normal (Wilson and Hilferty 1931), to about 1e-4 here.
    let (degrees, z) = (12_800.0, 2.0);
    let h: f64 = 2.0 / (9.0 * degrees);
    let statistic = degrees * libm::pow(1.0 - h + z * h.sqrt(), 3.0);
    assert!((chi_square_tail(statistic, 12_800) - 0.5 * two_sided_tail(z)).abs() < 1e-4);
}

#[test]
fn chi_square_pools_small_cells_and_refuses_impossible_ones() {
    assert_eq!(chi_square(&[10, 20, 1], &[10.0, 21.0, 0.0]), 0.0);
    // Pooled: 20 of 20 expected, 6 of 6 expected.
    assert_eq!(chi_square(&[20, 0, 6, 0, 0], &[20.0, 2.0, 2.0, 2.0, 0.0]), 1.0);
    assert!(chi_square(&[200, 100], &[150.0, 150.0]) < 1e-7);
}

#[test]
fn moments_of_parts_are_those_of_the_whole() {
    let values: Vec<f64> = (0..1000).map(|i| f64::from(i * i % 97)).collect();
    let whole = Moments::of(values.iter().copied());
    let parts = values.chunks(300).map(|part| Moments::of(part.iter().copied()));
    let joined = parts.fold(Moments::default(), Moments::with);
    assert!((joined.mean() - whole.mean()).abs() < 1e-12 * whole.mean());
    assert!((joined.variance() - whole.variance()).abs() < 1e-12 * whole.variance());
}
