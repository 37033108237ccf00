//! The list of what the generator makes.

use super::{blossom_tree, board, gallery, knight, spiral_scene};
use pathtracer::picture::Picture;

/// Every generated picture: its path below the project's root and its content.
pub(crate) fn pictures() -> Vec<(&'static str, Picture)> {
    vec![("objects/wood.png", gallery::wood()), ("objects/sky.exr", gallery::sky())]
}

/// Every generated text: its path below the project's root and its content.
pub(crate) fn all() -> Vec<(&'static str, String)> {
    let tree = blossom_tree::grow();
    vec![
        (
            "objects/board_dark.obj",
            board::squares(board::Shade::Dark).to_obj("Dark squares of a chess board", 3),
        ),
        (
            "objects/board_light.obj",
            board::squares(board::Shade::Light).to_obj("Light squares of a chess board", 3),
        ),
        (
            "objects/knight.obj",
            knight::piece().to_obj("A knight of chess, 2 units high, looking along +x", 4),
        ),
        ("objects/lantern.obj", gallery::lantern()),
        ("objects/lantern.mtl", gallery::lantern_materials()),
        ("objects/tree_bark.obj", tree.bark.to_obj("A tree in blossom: trunk, boughs and twigs", 4)),
        ("objects/tree_blossoms.obj", tree.blossoms.to_obj("A tree in blossom: the flowers", 3)),
        ("objects/tree_leaves.obj", tree.leaves.to_obj("A tree in blossom: the young leaves", 3)),
        ("objects/tree_petals.obj", tree.petals.to_obj("A tree in blossom: petals on the ground", 3)),
        ("scenes/legacyBalls.yaml", spiral_scene::yaml()),
    ]
}
