//! Mesh files as the parallel reader sees them: cuts, threads, numbers, long lines.

use super::meshes::{corners, load, mesh, mesh_of, signed_area};
use std::fmt::Write;

/// Bytes between the places from which the reader looks for a cut.
const WINDOW: usize = 1 << 20;

/// A square at x = `i` in the plane x = i, with all that makes a line end uncertain: continuations, some with blanks
/// behind the backslash, comments that end in a backslash, lines without words, two kinds of line ends.
fn block(text: &mut String, i: usize) {
    write!(
        text,
        "v {i} 0 0\r\nv {i} \\  \n 1 0\nv {i} 1 1 # c \\\n\n \t \nv {i} 0 \\\n\\\r\n1\nf -4 -3 \\\n-2 -1\n# {i}\\\n"
    )
    .unwrap();
}

/// The triangles of block `i`.
fn block_corners(i: usize) -> [[[f64; 3]; 3]; 2] {
    let p = |y, z| [i as f64, y, z];
    [[p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0)], [p(0.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)]]
}

#[test]
fn a_file_may_be_cut_anywhere() {
    let mut blocks = String::new();
    let mut count = 0;
    while blocks.len() < 2 * WINDOW + WINDOW / 2 {
        block(&mut blocks, count);
        count += 1;
    }
    let expected: Vec<[[f64; 3]; 3]> = (0..count).flat_map(block_corners).collect();
    // The shifts bring every byte of a block to the end of a window, or the byte beside it.
    for shift in (0..=150).step_by(2) {
        let text = format!("#{}\n{blocks}", "x".repeat(shift));
        assert!(corners(&mesh(&text)) == expected, "shifted by {shift}");
    }
}

#[test]
fn lines_may_be_longer_than_what_is_read_at_a_time() {
    let blanks = " ".repeat(WINDOW + 1000);
    let mut text = format!("# {}\nv 0 0 \\{blanks}\n 0\n{blanks}\n", "comment ".repeat(WINDOW / 3));
    // A polygon of so many corners on a parabola, which is convex.
    let count = 300_000usize;
    let mut face = "f 1".to_owned();
    for i in 1..count {
        writeln!(text, "v {i} {} 0", i * i).unwrap();
        write!(face, " {}", i + 1).unwrap();
    }
    let mesh = mesh(&format!("{text}{face}\n{blanks}"));
    assert_eq!(mesh.triangles.len(), count - 2);
    assert_eq!(mesh.positions[0], [0.0; 3]);
    let last = (count - 1) as f64;
    assert_eq!(mesh.positions[count - 1], [last, last * last, 0.0]);
}

#[test]
fn indices_reach_over_the_whole_file() {
    let count = 100_000;
    let mut text = format!("f 1 2 {count}\n");
    for i in 0..count {
        writeln!(text, "v {i} {} 0\nvt {i} 0\nvn 0 0 {}", i % 2, i + 1).unwrap();
    }
    writeln!(text, "f -{count}/-{count}/-{count} -2/-2/-2 -1/-1/-1").unwrap();
    assert!(text.len() > 2 * WINDOW);
    let mesh = mesh(&text);
    let position = |i: i32| [f64::from(i), f64::from(i % 2), 0.0];
    let expected = [[0, 1, count - 1].map(position), [0, count - 2, count - 1].map(position)];
    assert_eq!(corners(&mesh), expected);
    assert_eq!(mesh.texcoord_indices[0], [u32::MAX; 3]);
    let texcoords = mesh.texcoord_indices[1].map(|i| mesh.texcoords[i as usize][0]);
    assert_eq!(texcoords, [0.0, (count - 2) as f32, (count - 1) as f32]);
    let normals = mesh.normal_indices[1].map(|i| mesh.normals[i as usize][2]);
    assert_eq!(normals, [1.0, (count - 1) as f32, count as f32]);
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let mut text = "v 5 5 5\n".to_owned();
    for i in 0..60_000 {
        // Some faces have no area, some vertices no face, some faces no normals.
        let third = if i % 7 == 0 { 2 } else { 1 };
        writeln!(text, "v {i} 0 0\nv {i} 1 0\nv {i} 0 1\nvn 0 {} 1\nvt {i} 0", i % 3).unwrap();
        let corner = if i % 2 == 0 { "//-1" } else { "/-1" };
        writeln!(text, "f -3{corner} -2{corner} -{third}{corner}").unwrap();
    }
    assert!(text.len() > 2 * WINDOW);
    let load_with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let scene = pool.install(|| load(text.as_bytes()));
        let messages: Vec<String> = scene.warnings.iter().map(|warning| warning.message.clone()).collect();
        (mesh_of(&scene), messages.len())
    };
    let expected = load_with(1);
    for threads in [2, 3, 8] {
        assert!(load_with(threads) == expected, "{threads} threads");
    }
}

#[test]
fn vertices_are_there_once_for_all_groups_and_only_if_a_triangle_uses_them() {
    let mesh = mesh(
        "v 9 9 9\nv 0 0 0\nv 1 0 0\nvt 7 7\nvt 0.5 0.5\nvn 1 0 0\nvn 0 0 0\nvn 0 0 1\nv 8 8 8\nv 0 1 0\nv 1 1 0\n\
         g one\nf 2/2/3 3/2/3 5/2/3\ng two\nf 3/2/3 6/2/3 5/2/3\nl 1 4\nf 5/2/2 6/2/2 2/2/2\n",
    );
    assert_eq!(mesh.positions, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
    assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2], [2, 3, 0]]);
    assert_eq!(mesh.texcoords, [[0.5, 0.5]]);
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]]);
    assert_eq!(mesh.normal_indices, [[0; 3], [0; 3], [u32::MAX; 3]]);
}

/// The x that the reader makes of each of `numbers`.
fn read(numbers: &[String]) -> Vec<f64> {
    let mut text = "v 0 0 0\nv 0 0 1\n".to_owned();
    for number in numbers {
        // Whatever x is, the triangle has an area.
        writeln!(text, "v {number} 1 0\nf 1 2 -1").unwrap();
    }
    corners(&mesh(&text)).into_iter().map(|triangle| triangle[2][0]).collect()
}

fn assert_read_as_std_does(numbers: &[String]) {
    let found = read(numbers);
    assert_eq!(found.len(), numbers.len());
    for (number, found) in numbers.iter().zip(found) {
        let expected: f64 = number.parse().unwrap();
        assert_eq!(found.to_bits(), expected.to_bits(), "{number}: {found} instead of {expected}");
    }
}

#[test]
fn numbers_at_the_borders_of_the_short_way_are_rounded_correctly() {
    let mut numbers: Vec<String> = "0 -0 +1 .5 5. -.5 -5. 00000000000000000000001 1e5 1E5 1e+5 1e-5 -1e-05 1e22 1e23 1e-22 1e-23 \
        9007199254740991e22 9007199254740992e22 9007199254740993 9007199254740993e22 9007199254740993e-22 \
        900719925474099.3 9999999999999999999 99999999999999999999 18446744073709551616 0.1234567890123456789 \
        12345678 123456789 1234567.8 12345678.12345678 1.7976931348623157e308 2.2250738585072011e-308 4.9e-324 \
        1e-400 0e999999999999999999999 0.000000000000000000000000000000000000000000001e45 \
        8.5 123456789012345678901234567890e-20"
        .split_whitespace()
        .map(str::to_owned)
        .collect();
    // One digit more each, so that all lengths up to three times eight occur.
    for length in 1..=24 {
        numbers.push("123456789".chars().cycle().take(length).collect());
        numbers.push(format!("0.{}", "987654321".chars().cycle().take(length).collect::<String>()));
        numbers.push(format!("-7{}.25", "0".repeat(length)));
    }
    assert_read_as_std_does(&numbers);
}

#[test]
fn numbers_of_all_lengths_and_sizes_are_rounded_correctly() {
    // Knuth's MMIX generator; the high bits are good enough.
    let mut state = 7u64;
    let mut below = |limit: u64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) % limit
    };
    let mut numbers = Vec::new();
    for _ in 0..100_000 {
        let mut number = ["", "-"][below(2) as usize].to_owned();
        let (whole, places) = (1 + below(12), below(12));
        number.extend((0..whole).map(|_| char::from(b'0' + below(10) as u8)));
        if places > 0 {
            number.push('.');
            number.extend((0..places).map(|_| char::from(b'0' + below(10) as u8)));
        }
        if below(3) == 0 {
            write!(number, "e{}", below(60) as i64 - 30).unwrap();
        }
        numbers.push(number);
    }
    // The shortest texts that give any number back, of 1 to 17 digits.
    for _ in 0..20_000 {
        let number = f64::from_bits((below(1 << 31) << 33) | (below(1 << 31) << 2));
        if number.is_finite() {
            numbers.push(number.to_string());
            numbers.push(format!("{number:e}"));
        }
    }
    assert_read_as_std_does(&numbers);
}

/// A face of all the `points`, in their order.
fn polygon(points: &[[i64; 2]]) -> String {
    let mut text = String::new();
    let mut face = "f".to_owned();
    for (i, [x, y]) in points.iter().enumerate() {
        writeln!(text, "v {x} {y} 0").unwrap();
        write!(face, " {}", i + 1).unwrap();
    }
    format!("{text}{face}\n")
}

#[test]
fn a_hole_behind_a_bridge_stays_open() {
    let outer = [[0, 0], [8, 0], [8, 8], [0, 8]];
    let hole = [[2, 2], [2, 6], [6, 6], [6, 2]];
    let mut points = outer.to_vec();
    points.push(outer[0]);
    points.extend(hole);
    points.push(hole[0]);
    let mesh = mesh(&polygon(&points));
    assert_eq!(signed_area(&mesh), 64.0 - 16.0);
    let in_hole = |[a, b, c]: [[f64; 3]; 3]| {
        let center = [0, 1].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0);
        center.iter().all(|x| (2.0..6.0).contains(x))
    };
    assert!(!corners(&mesh).into_iter().any(in_hole));
}

#[test]
fn the_largest_concave_polygons_are_covered_once() {
    // A comb of 1023 teeth on a bar, and a staircase there and back. All coordinates are integers, so areas are exact.
    let mut comb = vec![[0, -1], [2045, -1]];
    for tooth in (0..1023).rev() {
        comb.extend([[2 * tooth + 1, 0], [2 * tooth + 1, 8], [2 * tooth, 8], [2 * tooth, 0]]);
    }
    let mut stairs: Vec<[i64; 2]> = (0..1024).flat_map(|i| [[i, i - 2], [i + 1, i - 2]]).collect();
    stairs.extend((0..1024).rev().flat_map(|i| [[i + 1, i + 1], [i, i + 1]]));
    for (points, area) in [(comb, 2045 + 1023 * 8), (stairs, 1024 * 3)] {
        let mesh = mesh(&polygon(&points));
        assert_eq!(signed_area(&mesh), area as f64);
        let doubled =
            |[a, b, c]: [[f64; 3]; 3]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        assert!(corners(&mesh).into_iter().all(|triangle| doubled(triangle) > 0.0));
    }
}
