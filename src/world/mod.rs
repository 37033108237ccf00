//! What is rendered: a scene compiled to flat arrays that are joined by indices. Nothing after
//! [`World::compile`] can fail on a user's input.
//!
//! World space is the scene's space moved so that its origin is the component-wise median of the positions of the
//! objects that are not much larger than the others, which is a subtraction in f64 and costs no precision near the
//! objects, wherever the scene lies.

mod camera;
mod coincident;
mod compile;
mod cone;
mod environment_map;
mod extent;
mod guards;
pub mod light;
mod meshes;
mod place;
mod requires;
mod shading;
mod sky;
mod smooth_balls;
mod texture;
mod varied;

pub use camera::Camera;
pub use cone::Cone;
pub use environment_map::environment_map_bytes;
pub use requires::Requires;
pub use sky::{Sky, SkyKind};
pub(crate) use smooth_balls::{MOST_SMOOTH_BALLS, SmoothBall};
pub use texture::texture_bytes;

use crate::geometry::{Geometry, Hit, Ray};
use crate::material::Material;
use crate::math::{DVec3, Rgb};
use crate::scene::desc::CameraDesc;
use light::{Lights, Receiver};
use shading::ShadingNormals;
use std::sync::Arc;
use varied::{Seen, Varied};

/// A scene, ready to be rendered.
#[derive(Clone, Debug)]
pub struct World {
    /// All primitives; worlds that differ in their materials only may share them, and so an accelerator.
    pub geometry: Arc<Geometry>,
    /// The sky.
    pub sky: Sky,
    /// All that shines.
    pub lights: Lights,
    /// What the scene needs.
    pub requires: Requires,
    /// The scene's point that is the origin of world space.
    pub origin: DVec3,
    /// Of every object.
    materials: Vec<Material>,
    /// Radiance that every object emits.
    emission: Vec<Rgb>,
    /// Normals of the mesh files, where they are used.
    normals: ShadingNormals,
    /// Materials that change over their object.
    varied: Varied,
}

/// Where a path meets a surface.
#[derive(Clone, Copy, Debug)]
pub struct Interaction {
    /// The point, with the geometric normal on the side that the ray came from.
    pub receiver: Receiver,
    /// The normal that materials see, on the side that the ray came from.
    pub normal: DVec3,
    /// Whether the ray came from the outer side.
    pub entering: bool,
}

impl World {
    /// The camera for a picture of `width` x `height` pixels.
    pub fn camera(&self, desc: &CameraDesc, width: u32, height: u32) -> Camera {
        Camera::new(desc, self.origin, width, height)
    }

    /// The material of an object.
    pub fn material(&self, object: u32) -> &Material {
        &self.materials[object as usize]
    }

    /// The material at a hit, where it changes over its object; else it is [`World::material`]. Pictures are looked up by
    /// the width of the [`Cone`] there.
    #[inline]
    pub fn varied_material(&self, hit: &Hit, at: &Interaction, width: f64) -> Option<Material> {
        let seen = Seen { geometry: &self.geometry, hit, normal: at.receiver.point.normal, width };
        self.varied.material(&seen, self.material(hit.object))
    }

    /// The radiance that an object emits.
    pub fn emission(&self, object: u32) -> Rgb {
        self.emission[object as usize]
    }

    /// The most that a component of the radiance of a light or of the sky is; 0 where there is no light.
    pub fn brightest(&self) -> f64 {
        self.emission.iter().fold(self.sky.brightest(), |most, emission| most.max(emission.max_element()))
    }

    /// The surface where a ray arrives.
    #[inline]
    pub fn interaction(&self, ray: &Ray, hit: &Hit) -> Interaction {
        let point = self.geometry.surface(ray, hit);
        let entering = ray.direction.dot(point.normal) < 0.0;
        let side = if entering { point.normal } else { -point.normal };
        let normal = self.normals.at(hit).map_or(side, |normal| {
            let normal = if normal.dot(side) < 0.0 { -normal } else { normal };
            // A normal that faces away from the viewer says nothing about what is seen.
            if normal.dot(ray.direction) < 0.0 { normal } else { side }
        });
        Interaction { receiver: Receiver { point, side }, normal, entering }
    }
}
