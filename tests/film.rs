use pathtracer::film::{Film, Sums};
use pathtracer::math::Rgb;

const CHUNK: u64 = 4;
const PIXELS: u64 = 3 * 2;

/// The sums of a chunk: numbers of very different sizes, so that every other order of adding gives other bits.
fn sums(chunk: u64) -> Vec<Rgb> {
    let value = |i: u64| libm::exp(libm::sin((i * 37 + chunk * 101) as f64) * 20.0);
    (0..PIXELS).map(|i| Rgb::new(value(3 * i), value(3 * i + 1), value(3 * i + 2))).collect()
}

fn film_of(chunks: impl IntoIterator<Item = u64>) -> Film {
    let mut film = Film::new(3, 2, CHUNK);
    for chunk in chunks {
        film.add(chunk, Sums::plain(CHUNK, sums(chunk))).expect("a chunk that is not there yet");
    }
    film
}

/// The sum of `count` chunks from `first`, by the definition of the tree.
fn tree_sum(first: u64, count: u64, pixel: usize) -> Rgb {
    match count {
        1 => sums(first)[pixel],
        _ => tree_sum(first, count / 2, pixel) + tree_sum(first + count / 2, count / 2, pixel),
    }
}

fn bits(film: &Film) -> Vec<[u64; 3]> {
    film.means().map(|mean| mean.to_array().map(f64::to_bits)).collect()
}

#[test]
fn chunks_are_combined_in_the_fixed_tree() {
    // 13 chunks: complete nodes of 8, 4 and 1, the smaller ones added first.
    for (pixel, mean) in film_of(0..13).means().enumerate() {
        let expected = (tree_sum(12, 1, pixel) + tree_sum(8, 4, pixel)) + tree_sum(0, 8, pixel);
        assert_eq!(mean, expected * (1.0 / (13 * CHUNK) as f64));
    }
}

#[test]
fn the_order_of_chunks_does_not_matter() {
    let forward = film_of(0..21);
    assert_eq!(film_of((0..21).rev()), forward);
    // 8 and 21 share no factor: a permutation.
    assert_eq!(film_of((0..21).map(|i| i * 8 % 21)), forward);
}

#[test]
fn any_split_at_chunk_borders_merges_to_the_same_bits() {
    let whole = film_of(0..21);
    for border in 1..21 {
        for (first, second) in [(0..border, border..21), (border..21, 0..border)] {
            let mut film = film_of(first);
            film.merge(film_of(second)).expect("parts without overlap");
            assert_eq!(bits(&film), bits(&whole));
        }
    }
}

#[test]
fn three_parts_merge_in_any_order() {
    let whole = film_of(0..21);
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let mut film = Film::new(3, 2, CHUNK);
        for part in order {
            film.merge(film_of([0..5, 5..14, 14..21][part].clone())).expect("parts without overlap");
        }
        assert_eq!(bits(&film), bits(&whole));
    }
}

#[test]
fn a_chunk_that_is_there_already_is_refused() {
    let mut film = film_of(0..6);
    assert!(film.add(3, Sums::plain(CHUNK, sums(3))).is_err());
    assert!(film.merge(film_of(5..7)).is_err());
    assert_eq!(film, film_of(0..6));
}

#[test]
fn a_film_of_another_size_is_refused() {
    let mut film = film_of(0..1);
    assert!(film.merge(Film::new(2, 3, CHUNK)).is_err());
    assert!(film.merge(Film::new(3, 2, CHUNK + 1)).is_err());
    assert!(film.add(1, Sums::plain(CHUNK + 1, sums(1))).is_err());
    assert!(film.add(1, Sums::plain(CHUNK, vec![Rgb::ZERO])).is_err());
}

#[test]
fn the_last_chunk_may_have_fewer_samples() {
    let mut film = film_of(0..3);
    film.add(3, Sums::plain(1, sums(3))).expect("a chunk that is not there yet");
    assert_eq!(film.samples(), 3 * CHUNK + 1);
    // It does not enter the tree, where it would be taken for a whole chunk.
    let first = film.means().next().expect("six pixels");
    let expected = (tree_sum(3, 1, 0) + tree_sum(2, 1, 0)) + tree_sum(0, 2, 0);
    assert_eq!(first, expected * (1.0 / 13.0));
}

#[test]
fn a_film_holds_no_more_nodes_than_it_says() {
    // Seen from outside: a binary counter up to n has at most floor(log2 n) + 1 digits.
    let most: Vec<u64> = [0, 1, 2, 3, 4, 63, 64].into_iter().map(Film::most_nodes).collect();
    assert_eq!(most, [1, 1, 2, 2, 3, 6, 7]);
}
