//! What the keys of a scene mean: from the tree of the YAML document to a [`SceneDesc`], one file a section.

mod camera;
mod environment;
mod material;
mod object;
mod picture;

use super::desc::{ObjectDesc, SceneDesc};
use super::diagnostic::{Finding, Report};
use super::meshes::Meshes;
use super::pictures::Pictures;
use super::source::Source;
use super::yaml::fields::{Fields, Section};
use super::yaml::node::{Kind, Node};
use super::yaml::value::Value;
use crate::error::Severity;
use std::path::Path;

/// The whole file.
const SCENE: Section = Section { name: "the scene", keys: &["Camera", "Environment", "Objects"] };

/// All sections, to say where a key belongs that stands in the wrong one.
const SECTIONS: [Section; 6] =
    [camera::SECTION, environment::SECTION, object::SECTION, material::SECTION, SCENE, picture::SECTION];

/// The most radiance that a light or the sky may have: products with areas and sums over lights stay within numbers.
const MOST_RADIANCE: f64 = 1e100;

/// What reading a value needs beside it.
pub(crate) struct Context<'c> {
    /// The scene's text.
    pub(crate) source: &'c Source<'c>,
    /// The meshes that it names.
    pub(crate) meshes: &'c mut Meshes,
    /// The pictures that it names.
    pub(crate) pictures: &'c mut Pictures,
    /// What is wrong with it.
    pub(crate) report: &'c mut Report,
}

/// Reads a scene; `None` after an error, which the report holds.
pub(crate) fn read(root: &Node<'_>, file: &Path, context: &mut Context<'_>) -> Option<SceneDesc> {
    let root = Value::root(root);
    let fields = Fields::open(root, &SCENE, &SECTIONS, context.report)?;
    let camera = fields.require("Camera", "Position, LookingAt, Fov and FocusDistance", context.report);
    let camera = camera.and_then(|value| camera::read(value, context.report));
    let environment = match fields.get("Environment") {
        Some(value) => environment::read(value, context),
        None => Some((environment::default(), None)),
    };
    let list = fields.require("Objects", "a list of objects", context.report);
    let objects = list.and_then(|list| objects(list, context));
    let (environment, environment_map) = environment?;
    Some(SceneDesc {
        file: file.to_path_buf(),
        camera: camera?,
        environment,
        environment_map,
        objects: objects?,
    })
}

/// Reads the list of objects.
fn objects(list: Value<'_>, context: &mut Context<'_>) -> Option<Vec<ObjectDesc>> {
    let Kind::List(items) = &list.node.kind else {
        let help = "each item is \"- Object:\" with its keys indented below".to_owned();
        list.refuse("a list", Some(help), context.report);
        return None;
    };
    if items.is_empty() {
        context.report.push(Finding {
            severity: Severity::Warning,
            subject: list.path.to_string(),
            text: " is empty: the picture will show only the sky".to_owned(),
            help: None,
            place: list.place(),
            elsewhere: None,
        });
    }
    context.meshes.read_ahead(items);
    let read = items.iter().enumerate().map(|(index, item)| object::read(list.item(index, item), context));
    // Not `collect::<Option<_>>`, which would stop at the first error.
    let objects: Vec<Option<Vec<ObjectDesc>>> = read.collect();
    objects.into_iter().collect::<Option<Vec<_>>>().map(|objects| objects.into_iter().flatten().collect())
}
