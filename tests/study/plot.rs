//! Plots are whole files with something on them.

use pathtracer::study::plot::Plot;

use super::bench::made_up;

fn rungs() -> Vec<pathtracer::study::bench::Rung> {
    let sizes = [1000, 10_000, 100_000];
    ["sphere", "cube", "soup"].iter().flat_map(|mesh| sizes.map(|size| made_up(mesh, size))).collect()
}

#[test]
fn an_svg_holds_a_panel_for_every_mesh_and_cost() {
    let rungs = rungs();
    let svg = Plot { heading: ["the heading", "the machine"], rungs: &rungs }.svg().expect("a plot");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    for word in ["the heading", "the machine", "native exact", "native fast", "100k"] {
        assert!(svg.contains(word), "{word}");
    }
    for mesh in ["sphere", "cube", "soup"] {
        assert_eq!(svg.matches(&format!("\n{mesh}\n")).count(), 2, "{mesh}");
    }
}

#[test]
fn a_png_has_ink_on_it() {
    let rungs = rungs();
    let (pixels, width, height) =
        Plot { heading: ["the heading", ""], rungs: &rungs }.pixels().expect("a plot");
    assert_eq!(pixels.len(), 3 * width as usize * height as usize);
    // The heading is dark on white.
    let row = |y: usize| &pixels[3 * y * width as usize..3 * (y + 1) * width as usize];
    assert!((14..44).any(|y| row(y).iter().any(|&value| value < 100)));
    assert!(row(2).iter().all(|&value| value == 255));
}

#[test]
fn a_single_size_can_be_plotted() {
    let rungs = [made_up("mesh.obj", 1234)];
    assert!(Plot { heading: ["", ""], rungs: &rungs }.svg().is_ok());
}

#[test]
fn nothing_can_be_plotted() {
    assert!(Plot { heading: ["", ""], rungs: &[] }.svg().is_ok());
}
