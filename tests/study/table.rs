//! Figures as text.

use pathtracer::study::rounds::{Spread, geometric_mean, interleaved};
use pathtracer::study::table::{Figure, Table, counted, csv, grouped, short};

#[test]
fn columns_are_aligned() {
    let mut table = Table::new(["", "first", "b"]);
    table.push(["name", "1", "22222"]);
    assert_eq!(table.to_string(), "      first      b\nname      1  22222\n");
}

#[test]
fn a_name_with_a_comma_is_quoted_in_csv() {
    let figure = Figure {
        mesh: "a,\"b\".yaml".into(),
        triangles: 12,
        accelerator: "native",
        precision: "exact",
        measure: "build".into(),
        threads: None,
        unit: "s",
        value: Spread { median: 1.5, min: 1.0, max: 2.0 },
    };
    let text = csv(&[figure]);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "mesh,triangles,accelerator,precision,measure,threads,unit,median,min,max");
    assert_eq!(lines[1], "\"a,\"\"b\"\".yaml\",12,native,exact,build,,s,1.5,1,2");
}

#[test]
fn short_numbers_have_three_digits() {
    let shown = [1234.5, 123.4, 12.34, 1.234, 0.1234, 0.001234, 0.0].map(short);
    assert_eq!(shown, ["1234", "123", "12.3", "1.23", "0.123", "0.00123", "0"]);
}

#[test]
fn counts_are_grouped_and_in_the_right_number() {
    assert_eq!([999, 1000, 1_234_567].map(grouped), ["999", "1,000", "1,234,567"]);
    assert_eq!([counted(1, "ray"), counted(2000, "ray")], ["1 ray", "2,000 rays"]);
}

#[test]
fn a_spread_holds_median_and_range() {
    assert_eq!(Spread::of(&[3.0, 1.0, 2.0]), Spread { median: 2.0, min: 1.0, max: 3.0 });
    assert_eq!(Spread::of(&[4.0, 1.0]).median, 2.5);
    assert_eq!(Spread::of(&[]), Spread::default());
}

#[test]
fn subjects_take_turns() {
    let mut order = Vec::new();
    let values = interleaved(2, &mut ['a', 'b'], |subject| {
        order.push(*subject);
        order.len() as f64
    });
    assert_eq!(order, ['a', 'b', 'a', 'b']);
    assert_eq!(values, [[1.0, 3.0], [2.0, 4.0]]);
}

#[test]
fn the_geometric_mean_is_that_of_factors() {
    // Of logarithms and an exponential, each good to a few ulp.
    assert!((geometric_mean([2.0, 8.0].into_iter()) - 4.0).abs() < 1e-14);
}
