//! Every value is reported at its own line and column, whatever the style of the file.

use super::diagnostics_of;
use pathtracer::error::Severity;

/// The same scene in the styles that YAML knows. `<` and `>` enclose the values that are damaged in turn.
const STYLES: [&str; 5] = [
    "Camera:
  Position: [<0>, <-5>, <1>]
  LookingAt: [<0>, <0>, <1>]
  Fov: <0.3>
  FocusDistance: <5>
Objects:
  - Object:
      Type: <Ball>
      Position: [<0>, <0>, <1>]
      Radius: <1>
      Material:
        Type: <Diffuse>
        Color: [<0.5>, <0.5>, <0.5>]
",
    "{Camera: {Position: [<0>,<-5>,<1>], LookingAt: [<0>,<0>,<1>], Fov: <0.3>,
  \"FocusDistance\":<5>}, # the end of the camera, [ { and all
 Objects: [ {Object: {Type: <Ball>, Position: [<0> ,<0> , <1>], 'Radius' : <1>,
    Material: {Type: <Diffuse>, Color: [ # red
  <0.5>, # green
      <0.5>,
      <0.5>]}}}]}
",
    "%YAML 1.1
---
Camera:
  Position:
  - <0>
  - <-5>
  - <1>
  LookingAt:
    - &zero <0>
    -   <0>
    -
      <1>
  Fov:

    <0.3>
  FocusDistance: &five <5>
Objects:
- Object:
    Name: |
      a text: with a colon
      - and a dash
    Type: <Ball>
    Position: [<0>, <0>, <1>]
    Radius:     <1>
    Material:
      Name: >-
        folded
        text
      Type: <Diffuse>
      Color: [<0.5>, <0.5>, <0.5>]
...
",
    "Camera:\r\n  Position: [<0>, <-5>, <1>]\r\n  LookingAt: [<0>, <0>, <1>]\r\n  Fov: <0.3>\r\n  FocusDistance: \
     <5>\r\nObjects:\r\n  - Object:\r\n      Name: \"Κύκλος \u{7403} ⚪\"\r\n      Type: <Ball>\r\n      Position: \
     [<0>, <0>, <1>]\r\n      Radius: <1>\r\n      Material: {Name: größer, Type: <Diffuse>, Color: [<0.5>, \
     <0.5>, <0.5>]}\r\n",
    "Objects:
  - Object: {? Type : <Ball>, Name: 'it''s', Position: &p [<0>, <0>, <1>], Radius: <1>, Material: &m {
      Type: <Diffuse>, Color: &grey [<0.5>, <0.5>, <0.5>]}}
  - Object: {Type: Ball, Position: *p, Radius: 1, Material: *m}
  - Object: {Type: Ball, Position: *p, Radius: 1, Material: {Type: Diffuse, Color: *grey}}
Camera:
  ? Position
  : [<0>, <-5>, <1>]
  LookingAt: [<0>,\t<0>, <1>]
  Fov: <0.3>\t
  FocusDistance: <5>
",
];

/// Line and column of byte `offset`.
fn place(text: &str, offset: usize) -> (usize, usize) {
    let before = &text[..offset];
    let line = before.matches('\n').count() + 1;
    let start = before.rfind('\n').map_or(0, |end| end + 1);
    (line, before[start..].chars().count() + 1)
}

/// The text without its marks, with value number `index` replaced, and the place of that value.
fn damage(style: &str, index: usize, replacement: &str) -> Option<(String, (usize, usize))> {
    let mut text = String::new();
    let mut found = None;
    for (i, piece) in style.split('<').enumerate() {
        let Some((value, rest)) = piece.split_once('>').filter(|_| i > 0) else {
            text.push_str(piece);
            continue;
        };
        if i == index + 1 {
            found = Some(text.len());
        }
        text.push_str(if i == index + 1 { replacement } else { value });
        text.push_str(rest);
    }
    let offset = found?;
    let at = place(&text, offset);
    Some((text, at))
}

#[test]
fn every_value_has_its_place_in_every_style() {
    for style in STYLES {
        // The block scalars' indicators must not be taken for marks.
        let style = style.replace(">-", "|-");
        for index in 0..14 {
            for replacement in ["nope", "[nope, 1]", "{nope: 1}", "'nope'", "\"n\\x6fpe\"", "'no''pe'", "~"] {
                let (text, expected) = damage(&style, index, replacement).unwrap();
                let diagnostics = diagnostics_of(&text);
                let [only] = diagnostics.as_slice() else { panic!("{text}\n{diagnostics:?}") };
                assert_eq!(only.severity, Severity::Error);
                let location = only.location.as_ref().unwrap();
                assert_eq!((location.line, location.column), expected, "{only}\n{text}");
            }
        }
    }
}
