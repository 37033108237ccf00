//! Charts are whole files with something on them.

use pathtracer::study::plot::chart::{Chart, Guide, Mark, Point, Scale, Series, Sheet};

fn chart(scales: [Scale; 2], points: Vec<Point>) -> Chart {
    let series =
        Series { name: "a series".into(), color: [35, 35, 220], mark: Mark::Square, line: 1, points };
    let guide = Guide { name: "a guide".into(), power: -1.0, through: [1.0, 1.0] };
    Chart {
        title: "the title".into(),
        labels: ["along".into(), "up".into()],
        scales,
        series: vec![series],
        guides: vec![guide],
    }
}

#[test]
fn an_svg_holds_the_words_of_all_charts() {
    let points =
        vec![Point::bare(1e-4, 0.5), Point { at: [2000.0, 1.0], bars: [[1000.0, 3000.0], [0.5, 2.0]] }];
    let charts =
        vec![chart([Scale::Log, Scale::Log], points.clone()), chart([Scale::Log, Scale::Linear], points)];
    let sheet = Sheet { heading: Some(["the heading".into(), "the machine".into()]), charts };
    let svg = sheet.svg().expect("a drawing");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    for (word, times) in
        [("the heading", 1), ("the machine", 1), ("the title", 2), ("a series", 2), ("a guide", 2)]
    {
        assert_eq!(svg.matches(&format!("\n{word}\n")).count(), times, "{word}");
    }
    for tick in ["1e-4", "1k"] {
        assert!(svg.contains(&format!("\n{tick}\n")), "{tick}");
    }
    let (pixels, width, height) = sheet.pixels().expect("a drawing");
    assert_eq!(pixels.len(), 3 * width as usize * height as usize);
    assert!(pixels.chunks_exact(3).any(|pixel| pixel == [35, 35, 220]));
}

#[test]
fn what_is_not_on_an_axis_is_left_out() {
    let odd = [f64::NAN, f64::INFINITY, 0.0, -1.0].map(|y| Point::bare(1.0, y));
    for scale in [Scale::Log, Scale::Linear] {
        for points in [Vec::new(), odd.to_vec(), vec![Point::bare(1.0, 3.0)]] {
            let sheet = Sheet { heading: None, charts: vec![chart([Scale::Log, scale], points)] };
            assert!(sheet.svg().is_ok());
        }
    }
    assert!(Sheet { heading: None, charts: Vec::new() }.svg().is_ok());
}
