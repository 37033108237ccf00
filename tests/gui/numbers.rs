//! Numbers of colours and materials: what is out of range is not taken, and marked.

use super::Desk;
use super::panels::{Window, window};
use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, Rect};
use egui_kittest::kittest::{NodeT, Queryable};
use pathtracer::scene::edit::Surface;

/// Types into the first number beside this label.
fn type_number(window: &mut Window<'_>, label: &str, text: &str) {
    let at = {
        let mut labels = window.get_all_by_role_and_label(Role::Label, label);
        let label = labels.next().expect("a label").rect();
        let numbers = window.get_all_by_role(Role::SpinButton).map(|node| node.rect());
        let is_beside =
            |rect: &Rect| rect.y_range().contains(label.center().y) && rect.left() > label.right();
        let beside = numbers.filter(is_beside).min_by(|a, b| a.left().total_cmp(&b.left()));
        beside.expect("a number beside the label").center()
    };
    window.hover_at(at);
    window.run_steps(1);
    for pressed in [true, false] {
        window.event(eframe::egui::Event::PointerButton {
            pos: at,
            button: eframe::egui::PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        window.run_steps(1);
    }
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.run_steps(1);
    window.event(eframe::egui::Event::Text(text.into()));
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(2);
}

fn surface(window: &Window<'_>, index: usize) -> Surface {
    let editable = window.state().0.editable.clone().expect("a scene");
    editable.surfaces[index].clone().expect("a material of its own")
}

fn opened<'w>(desk: &Desk, object: usize) -> Window<'w> {
    let mut window = window(desk);
    window.state_mut().0.selected = Some(object);
    window.run_steps(3);
    window
}

#[test]
fn a_number_of_a_material_out_of_range_is_marked_and_not_taken() {
    let desk = Desk::new();
    let mut window = opened(&desk, 1);
    let why = "expected a number from 0 to 1";
    type_number(&mut window, "Coat", "1.5");
    window.get_by_label(why);
    assert_eq!(surface(&window, 1).coat, 0.5);
    type_number(&mut window, "Coat", "0.75");
    assert!(window.query_by_label(why).is_none());
    assert_eq!(surface(&window, 1).coat, 0.75);
}

#[test]
fn a_negative_strength_is_marked_and_not_taken() {
    let desk = Desk::new();
    let mut window = opened(&desk, 2);
    type_number(&mut window, "Emission", "-1");
    window.get_by_label("expected a number from 0 to 1000000");
    assert_eq!(surface(&window, 2).emission_strength, 20.0);
}

#[test]
fn a_mark_goes_with_another_object() {
    let desk = Desk::new();
    let mut window = opened(&desk, 1);
    let why = "expected a number from 0 to 1";
    type_number(&mut window, "Coat", "1.5");
    window.state_mut().0.selected = Some(2);
    window.run_steps(3);
    assert!(window.query_by_label(why).is_none());
}

#[test]
fn light_above_1_keeps_its_hue_while_its_brightness_changes() {
    let desk = Desk::new();
    let mut window = opened(&desk, 2);
    window.state_mut().0.edit(|editable| {
        let surface = editable.surfaces[2].as_mut().expect("a material of its own");
        surface.emission_color = pathtracer::math::Rgb::new(8.0, 4.0, 2.0);
    });
    window.run_steps(3);
    type_number(&mut window, "brightest", "4");
    assert_eq!(surface(&window, 2).emission_color.to_array(), [4.0, 2.0, 1.0]);
}

#[test]
fn coordinates_of_six_characters_fit_their_fields() {
    let desk = Desk::new();
    let mut window = window(&desk);
    window.state_mut().0.edit(|editable| editable.camera.position.x = -12.75);
    window.run_steps(3);
    for axis in ["Position", "Look at"] {
        let fields = window.get_all_by_role(Role::TextInput);
        let own = fields
            .filter(|node| node.accesskit_node().labelled_by().any(|by| by.value().as_deref() == Some(axis)));
        let widths: Vec<f32> = own.map(|node| node.rect().width()).collect();
        let font = eframe::egui::TextStyle::Body.resolve(&window.ctx.global_style());
        let text = window.ctx.fonts_mut(|fonts| {
            fonts.layout_no_wrap("-12.75".into(), font, eframe::egui::Color32::WHITE).size().x
        });
        // Margins of eight points on either side.
        assert!(
            widths.len() == 3 && widths.iter().all(|width| *width >= text + 16.0),
            "{widths:?} for {text}"
        );
    }
}
