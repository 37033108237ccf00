//! The order of the samples in the scrambles.

use pathtracer::sampling::{Place, SCRAMBLES, Scrambles};
use std::collections::HashSet;

const LENGTHS: [u64; 4] = [1, 2, 3, 128];

#[test]
fn no_two_samples_share_a_place() {
    for length in LENGTHS {
        let scrambles = Scrambles::new(length);
        let places: HashSet<u64> = (0..20_000).map(|i| scrambles.place(i).sample_index()).collect();
        assert_eq!(places.len(), 20_000);
    }
}

#[test]
fn the_points_of_a_scramble_come_in_order_without_gaps() {
    for length in LENGTHS {
        let mut next = [0; SCRAMBLES];
        for sample in 0..20_000 {
            let Place { scramble, index } = Scrambles::new(length).place(sample);
            assert_eq!(index, next[scramble], "sample {sample}, length {length}");
            next[scramble] += 1;
        }
    }
}

#[test]
fn counts_are_those_of_the_places() {
    for length in LENGTHS {
        let scrambles = Scrambles::new(length);
        let mut counts = [0; SCRAMBLES];
        for sample in 0..5000 {
            assert_eq!(scrambles.counts(sample), counts);
            counts[scrambles.place(sample).scramble] += 1;
        }
    }
}

#[test]
fn all_scrambles_are_equally_long_after_every_round() {
    for length in LENGTHS {
        for round in 0..8 {
            let each = length << round;
            assert_eq!(Scrambles::new(length).counts(8 * each), [each; SCRAMBLES]);
        }
    }
}

#[test]
fn the_first_scramble_comes_first() {
    for sample in 0..128 {
        assert_eq!(Scrambles::new(128).place(sample).sample_index(), sample);
    }
    assert_eq!(Scrambles::new(128).place(128), Place { scramble: 1, index: 0 });
    assert_eq!(Scrambles::new(128).place(1024), Place { scramble: 0, index: 128 });
}

#[test]
fn samples_of_one_scramble_are_known_as_such() {
    for length in LENGTHS {
        let scrambles = Scrambles::new(length);
        for start in 0..600 {
            for size in [1, 2, 5, 16, 128] {
                let all: HashSet<usize> =
                    (start..start + size).map(|i| scrambles.place(i).scramble).collect();
                let only = scrambles.only(start..start + size);
                assert_eq!(only.is_some(), all.len() == 1, "{start} + {size}, length {length}");
                assert!(only.is_none_or(|scramble| all.contains(&scramble)));
            }
        }
    }
}

#[test]
fn the_last_sample_has_a_place_of_its_own() {
    let last = (1 << 32) - 1;
    for length in [1, 128, 1 << 32] {
        let Place { scramble, index } = Scrambles::new(length).place(last);
        assert!(scramble < SCRAMBLES && index <= last);
    }
}

#[test]
fn other_sets_are_other_scrambles() {
    let place = Scrambles::new(2).place(5);
    let scrambles: HashSet<usize> = (0..8).map(|set| place.in_set(set).scramble).collect();
    assert_eq!(scrambles.len(), 8);
    assert_eq!(place.in_set(0), place);
}
