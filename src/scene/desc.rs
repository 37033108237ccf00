//! What the scene file says, resolved to numbers: defaults filled in, file names found, nothing compiled.
//! Ranges are those of the scene reference in the README; a value of these types has passed them.

use crate::error::Location;
use crate::math::{DVec3, Rgb};
use crate::picture::Decoded;
use std::path::PathBuf;
use std::sync::Arc;

/// A whole scene file, with the meshes it names.
#[derive(Clone, Debug)]
pub struct SceneDesc {
    /// The file as the user named it.
    pub file: PathBuf,
    /// The camera.
    pub camera: CameraDesc,
    /// The sky.
    pub environment: EnvironmentDesc,
    /// A picture that takes the place of the sky's colours, but not of its strength.
    pub environment_map: Option<EnvironmentMapDesc>,
    /// The objects in the order of the file.
    pub objects: Vec<ObjectDesc>,
}

/// The camera: thin lens, horizontal field of view.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraDesc {
    /// Centre of the lens.
    pub position: DVec3,
    /// Point in the middle of the picture, different from `position`.
    pub looking_at: DVec3,
    /// Horizontal field of view between the outer edges of the picture, as a fraction of pi, in (0, 1).
    pub fov: f64,
    /// Distance of the sharp plane along the viewing direction, > 0.
    pub focus_distance: f64,
    /// Size of the lens.
    pub aperture: ApertureDesc,
    /// Roll about the viewing direction in degrees.
    pub angle: f64,
}

/// The two ways to say how large the lens is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ApertureDesc {
    /// `DepthOfField` >= 0: lens radius = this x (width of the view at the focus distance) / 1920.
    DepthOfField(f64),
    /// `ApertureRadius` >= 0: the lens radius in scene units.
    Radius(f64),
}

/// The gradient sky.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentDesc {
    /// Radiance from the zenith.
    pub sky: Rgb,
    /// Radiance from the horizon.
    pub horizon: Rgb,
    /// Radiance from the nadir.
    pub ground: Rgb,
    /// A factor on all three, >= 0.
    pub strength: f64,
}

/// A picture of the whole sphere: latitude and longitude.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentMapDesc {
    /// Radiance. The middle column is +x, to its right follow -y, -x and +y; the top row is +z.
    pub picture: PictureDesc,
    /// Turns it about z, in degrees.
    pub rotation: f64,
}

/// A picture that the scene names.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureDesc {
    /// The file that was found.
    pub file: PathBuf,
    /// Its content, finite and not negative; all that name the same file share it.
    pub picture: Arc<Decoded>,
    /// Whether its values are sRGB-encoded.
    pub is_encoded: bool,
}

/// One object.
#[derive(Clone, Debug)]
pub struct ObjectDesc {
    /// The optional `Name`.
    pub name: Option<String>,
    /// Where the object stands in the file.
    pub location: Location,
    /// Its shape.
    pub shape: ShapeDesc,
    /// Its material.
    pub material: MaterialDesc,
    /// Where other materials begin among the triangles of a mesh: the first triangle, ascending, and the material. None of
    /// them emits.
    pub faces: Vec<(u32, Arc<MaterialDesc>)>,
}

/// The shapes of the format. Rotations are angles in degrees about the world's x, then y, then z axis.
#[derive(Clone, Debug)]
pub enum ShapeDesc {
    /// A sphere.
    Ball {
        /// Centre.
        position: DVec3,
        /// Radius > 0.
        radius: f64,
    },
    /// A box.
    Box {
        /// Centre.
        position: DVec3,
        /// Full edge lengths along x (`Depth`), y (`Width`), z (`Height`), each > 0.
        size: DVec3,
        /// Angles in degrees.
        rotation: DVec3,
    },
    /// A rectangle in the plane x = 0 before the rotation, its front facing -x.
    Rectangle {
        /// Centre.
        position: DVec3,
        /// Full length along y, > 0.
        width: f64,
        /// Full length along z, > 0.
        height: f64,
        /// Angles in degrees.
        rotation: DVec3,
    },
    /// A mesh of triangles from an OBJ file.
    TriangleMesh {
        /// The file that was found.
        file: PathBuf,
        /// Its content; objects that name the same file share it.
        mesh: Arc<MeshDesc>,
        /// Factor > 0.
        scale: f64,
        /// Where the origin of the file goes.
        position: DVec3,
        /// Angles in degrees.
        rotation: DVec3,
        /// How the axes of the file are read.
        axes: Axes,
        /// Whether normals of the file shade the surface.
        smooth: bool,
    },
}

/// How the coordinates (x, y, z) of a mesh file become the world's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axes {
    /// (x, -z, y): a rotation.
    YUp,
    /// (x, y, z).
    ZUp,
    /// (x, z, y): mirrors.
    SwapYZ,
}

/// The content of a mesh file. All numbers are finite, all indices in range, no triangle is without area, and each
/// position, normal and texture coordinate is used by one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshDesc {
    /// Vertex positions.
    pub positions: Vec<[f64; 3]>,
    /// Vertex normals of the file, any length but zero.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates of the file.
    pub texcoords: Vec<[f32; 2]>,
    /// Indices into `positions`, three a triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Indices into `normals`, one entry a triangle, or empty; `[u32::MAX; 3]` where a face has none.
    pub normal_indices: Vec<[u32; 3]>,
    /// Indices into `texcoords`, one entry a triangle, or empty; `[u32::MAX; 3]` where a face has none.
    pub texcoord_indices: Vec<[u32; 3]>,
    /// Where the materials of the file begin: the first triangle, ascending, and the name.
    pub materials: Vec<(u32, String)>,
    /// The names of the files that hold its materials.
    pub libraries: Vec<String>,
}

/// A material with its optional name.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialDesc {
    /// The optional `Name`.
    pub name: Option<String>,
    /// What it does with light.
    pub kind: MaterialKind,
    /// Pictures of its colours, which those of `kind` are multiplied by.
    pub textures: TexturesDesc,
}

/// The pictures of a material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TexturesDesc {
    /// Of the reflectance; of [`MaterialKind::ClearCoat`] that of the base.
    pub color: Option<PictureDesc>,
    /// Of the reflectance of a coat.
    pub coat_color: Option<PictureDesc>,
}

/// The materials of the format. Reflectances lie in 0..1.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialKind {
    /// Lambertian, possibly an area light.
    Diffuse {
        /// Reflectance.
        color: Rgb,
        /// Emitted radiance (strength x colour); zero means none.
        emission: Rgb,
    },
    /// The lerp lobe.
    Reflective {
        /// Reflectance.
        color: Rgb,
        /// 1 is a perfect mirror, 0 Lambertian.
        specularity: f64,
    },
    /// A reflective coat over a diffuse base.
    ClearCoat {
        /// Reflectance of the base.
        color: Rgb,
        /// Probability of the coat.
        coat: f64,
        /// Reflectance of the coat.
        coat_color: Rgb,
        /// Specularity of the coat.
        specularity: f64,
    },
    /// A smooth dielectric.
    Refractive {
        /// Factor at every interface.
        color: Rgb,
        /// n outside / n inside, > 0.
        ratio: f64,
    },
}

impl MaterialKind {
    /// The radiance that its surface emits; zero is none.
    pub fn emission(&self) -> Rgb {
        match *self {
            MaterialKind::Diffuse { emission, .. } => emission,
            MaterialKind::Reflective { .. }
            | MaterialKind::ClearCoat { .. }
            | MaterialKind::Refractive { .. } => Rgb::ZERO,
        }
    }

    /// Whether its surface is a light.
    pub fn emits(&self) -> bool {
        self.emission() != Rgb::ZERO
    }
}
