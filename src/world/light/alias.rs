//! Vose's alias table: choosing from a fixed distribution in constant time (IEEE Trans. Software Eng. 17(9) 1991).

/// A distribution over indices.
#[derive(Clone, Debug, Default)]
pub(crate) struct AliasTable {
    /// Probability of staying in a slot, the other index of the slot, and the probability of the slot's own index.
    slots: Vec<(f64, u32, f64)>,
}

impl AliasTable {
    /// The distribution proportional to `weights`, each >= 0 and finite. All zero, or none: nothing is ever chosen.
    pub(crate) fn new(weights: &[f64]) -> AliasTable {
        // Scaled first, so that neither tiny nor huge weights leave the range of numbers.
        let largest = weights.iter().copied().fold(0.0, f64::max);
        if largest == 0.0 {
            return AliasTable::default();
        }
        let total: f64 = weights.iter().map(|w| w / largest).sum();
        let probability = |w: f64| w / largest / total;
        let count = weights.len() as f64;
        let mut slots: Vec<(f64, u32, f64)> = weights
            .iter()
            .enumerate()
            .map(|(i, &w)| (probability(w) * count, i as u32, probability(w)))
            .collect();
        let (mut small, mut large): (Vec<usize>, Vec<usize>) =
            (0..slots.len()).partition(|&i| slots[i].0 < 1.0);
        while let (Some(s), Some(&l)) = (small.pop(), large.last()) {
            slots[s].1 = l as u32;
            slots[l].0 -= 1.0 - slots[s].0;
            if slots[l].0 < 1.0 {
                large.pop();
                small.push(l);
            }
        }
        for rest in small.into_iter().chain(large) {
            // What rounding left over: these slots keep their own index, unless that has no weight.
            if slots[rest].2 > 0.0 {
                slots[rest].0 = 1.0;
            }
        }
        AliasTable { slots }
    }

    /// An index, its probability, and `u` in [0, 1) made new. `None` if nothing can be chosen.
    pub(crate) fn sample(&self, u: f64) -> Option<(u32, f64, f64)> {
        let scaled = u * self.slots.len() as f64;
        let slot = (scaled as usize).min(self.slots.len().checked_sub(1)?);
        let (stay, other, _) = self.slots[slot];
        let rest = scaled - slot as f64;
        let (index, rest) =
            if rest < stay { (slot as u32, rest / stay) } else { (other, (rest - stay) / (1.0 - stay)) };
        Some((index, self.probability(index), rest.clamp(0.0, BELOW_ONE)))
    }

    /// The probability of an index.
    pub(crate) fn probability(&self, index: u32) -> f64 {
        self.slots.get(index as usize).map_or(0.0, |slot| slot.2)
    }
}

/// The largest number below 1.
pub(super) const BELOW_ONE: f64 = 1.0 - f64::EPSILON / 2.0;
