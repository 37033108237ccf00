//! Changing a scene in its text: the values that a window can edit, and writing them back so that comments, order and every
//! line that did not change stay as they are.

mod moved;
mod surface;
mod text;

pub use moved::moved;
pub use surface::{Surface, SurfaceKind};

use super::desc::{ApertureDesc, CameraDesc, EnvironmentDesc, SceneDesc};
use super::source::Source;
use super::yaml::{self, node::Kind, node::Node};
use crate::error::{Error, Result};
use crate::math::DVec3;
use std::path::Path;
use text::Step;

/// What can be edited of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Editable {
    /// The camera.
    pub camera: CameraDesc,
    /// The sky; of a sky with a picture only its strength counts.
    pub environment: EnvironmentDesc,
    /// Of the sky's picture, in degrees; `None` without one.
    pub rotation: Option<f64>,
    /// The materials of the objects; `None` where it comes from the mesh's file.
    pub surfaces: Vec<Option<Surface>>,
}

impl Editable {
    /// What can be edited of a scene that was read from `text`.
    pub fn read(text: &str, desc: &SceneDesc) -> Editable {
        let source = Source::new(&desc.file, text);
        let written = yaml::parse(&source).ok();
        let items = written.as_ref().map(|root| items_of(root, desc)).unwrap_or_default();
        let surface = |(index, item): (usize, &Option<usize>)| {
            let material = object_node(written.as_ref()?, (*item)?)?.entry("Material")?;
            Surface::read(material, &desc.objects.get(index)?.material)
        };
        Editable {
            camera: desc.camera.clone(),
            environment: desc.environment.clone(),
            rotation: desc.environment_map.as_ref().map(|map| map.rotation),
            surfaces: items.iter().enumerate().map(surface).collect(),
        }
    }

    /// Puts the values into the description that they were read with.
    pub fn put(&self, desc: &mut SceneDesc) {
        desc.camera = self.camera.clone();
        desc.environment = self.environment.clone();
        if let (Some(map), Some(rotation)) = (&mut desc.environment_map, self.rotation) {
            map.rotation = rotation;
        }
        for (object, surface) in desc.objects.iter_mut().zip(&self.surfaces) {
            if let Some(surface) = surface {
                object.material.kind = surface.material();
            }
        }
    }
}

/// The text of a scene whose values `before` became `after`.
///
/// Only the bytes of values that differ are replaced; a key that is missing gets a line of its own.
///
/// # Errors
/// [`Error::Usage`] where the text can't say it: a value that stands elsewhere too, by an anchor and its aliases.
pub fn save(text: &str, desc: &SceneDesc, after: &Editable) -> Result<String> {
    let before = Editable::read(text, desc);
    let mut text = text.to_owned();
    for change in changes(text.as_str(), desc, &before, after) {
        text = change.apply(&text, &desc.file)?;
    }
    verify(&text, desc, after)?;
    Ok(text)
}

/// Whether the text says what it should.
fn verify(text: &str, desc: &SceneDesc, after: &Editable) -> Result<()> {
    let read = super::parse(text, &desc.file)?;
    let mut wanted = desc.clone();
    after.put(&mut wanted);
    let is_same = read.desc.camera == wanted.camera
        && read.desc.environment == wanted.environment
        && read.desc.environment_map == wanted.environment_map
        && read.desc.objects.len() == wanted.objects.len()
        && read.desc.objects.iter().zip(&wanted.objects).all(|(a, b)| a.material == b.material)
        && Editable::read(text, &read.desc) == *after;
    if is_same {
        return Ok(());
    }
    Err(Error::Usage(
        "the scene can't be saved: a value that was changed stands in several places, by an anchor (&) and its aliases \
         (*); give each place a value of its own"
            .into(),
    ))
}

/// A value to be written.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Written {
    Number(f64),
    Vector(DVec3),
    Word(&'static str),
}

/// A value that becomes another.
struct Change {
    /// The way to the mapping.
    section: Vec<Step>,
    key: &'static str,
    value: Written,
    /// The key that a new line goes behind.
    after: &'static str,
}

impl Change {
    fn apply(&self, text: &str, file: &Path) -> Result<String> {
        let source = Source::new(file, text);
        let root = yaml::parse(&source).map_err(|diagnostic| Error::Scene(vec![*diagnostic]))?;
        text::Editor { text, root: &root }.set(&self.section, self.key, self.value, self.after)
    }
}

/// The changes between two states, in the order of the sections.
fn changes(text: &str, desc: &SceneDesc, before: &Editable, after: &Editable) -> Vec<Change> {
    let mut changes = Vec::new();
    let mut add = |section: &[Step], key, value: Written, after| {
        changes.push(Change { section: section.to_vec(), key, value, after });
    };
    let camera = [Step::Key("Camera")];
    let values = camera_values(&before.camera).into_iter().zip(camera_values(&after.camera));
    for ((key, old), (_, new)) in values {
        if old != new {
            add(&camera, key, new, "FocusDistance");
        }
    }
    let sky = [Step::Key("Environment")];
    let has_map = before.rotation.is_some();
    let values = sky_values(&before.environment, before.rotation).into_iter();
    for ((key, old), (_, new)) in values.zip(sky_values(&after.environment, after.rotation)) {
        if old != new && (!has_map || matches!(key, "Strength" | "Rotation")) {
            add(&sky, key, new, if has_map { "Image" } else { "" });
        }
    }
    let source = Source::new(&desc.file, text);
    let items = yaml::parse(&source).map(|root| items_of(&root, desc)).unwrap_or_default();
    for ((item, old), new) in items.iter().zip(&before.surfaces).zip(&after.surfaces) {
        if let (Some(item), Some(old), Some(new)) = (item, old, new) {
            let material =
                [Step::Key("Objects"), Step::Item(*item), Step::Key("Object"), Step::Key("Material")];
            for (key, value) in new.changes_since(old) {
                add(&material, key, value, "Type");
            }
        }
    }
    changes
}

fn camera_values(camera: &CameraDesc) -> [(&'static str, Written); 6] {
    let aperture = match camera.aperture {
        ApertureDesc::DepthOfField(strength) => ("DepthOfField", Written::Number(strength)),
        ApertureDesc::Radius(radius) => ("ApertureRadius", Written::Number(radius)),
    };
    [
        ("Position", Written::Vector(camera.position)),
        ("LookingAt", Written::Vector(camera.looking_at)),
        ("Fov", Written::Number(camera.fov)),
        ("FocusDistance", Written::Number(camera.focus_distance)),
        aperture,
        ("Angle", Written::Number(camera.angle)),
    ]
}

fn sky_values(sky: &EnvironmentDesc, rotation: Option<f64>) -> [(&'static str, Written); 5] {
    [
        ("SkyColor", Written::Vector(sky.sky)),
        ("HorizonColor", Written::Vector(sky.horizon)),
        ("GroundColor", Written::Vector(sky.ground)),
        ("Strength", Written::Number(sky.strength)),
        ("Rotation", Written::Number(rotation.unwrap_or(0.0))),
    ]
}

/// The item of `Objects` that holds each object's material; `None` for materials from a mesh's file.
fn items_of(root: &Node<'_>, desc: &SceneDesc) -> Vec<Option<usize>> {
    let Some(Kind::List(list)) = root.entry("Objects").map(|node| &node.kind) else { return Vec::new() };
    let is_from_file = |item: usize| {
        let material = object_node(root, item).and_then(|object| object.entry("Material"));
        material.is_some_and(|material| material.text() == Some("FromFile"))
    };
    let mut items = Vec::with_capacity(desc.objects.len());
    let mut next = 0;
    let mut location = None;
    for object in &desc.objects {
        // An item with materials of the mesh's file is several objects, which stand in the same place.
        let goes_on = next > 0 && is_from_file(next - 1) && location == Some(&object.location);
        if !goes_on {
            next += 1;
        }
        location = Some(&object.location);
        items.push((next <= list.len() && !is_from_file(next - 1)).then(|| next - 1));
    }
    items
}

fn object_node<'n, 't>(root: &'n Node<'t>, item: usize) -> Option<&'n Node<'t>> {
    match &root.entry("Objects")?.kind {
        Kind::List(items) => items.get(item)?.entry("Object"),
        _ => None,
    }
}
