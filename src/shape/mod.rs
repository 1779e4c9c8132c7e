//! Ready-made starting meshes; those of the kernel, with the parameters of the verb and the step
//! `solid`.

pub use kerfold_kernel::shape::{
    Archimedean, Platonic, ShapeError, SolidName, SolidSize, antiprism, archimedean, cube, cuboid,
    dodecahedron, geodesic, hexagonal_facade, icosahedron, octahedron, platonic, prism,
    random_tangent_polytope, soccer_ball, solid_names, tetrahedron,
};

use crate::mesh::Mesh;
use crate::units::Length;

/// Which ready-made solid, and how large.
#[derive(Debug, Clone, PartialEq, clap::Args, serde::Deserialize)]
pub struct SolidParams {
    /// Name of the solid: a Platonic or Archimedean solid (`cube`, `truncated-icosahedron` =
    /// `soccer-ball`, …), `prism-N`, `antiprism-N`, `geodesic-N` or `box-AxBxC` (extents in mm)
    #[serde(alias = "solid")]
    pub name: SolidName,
    /// Length of an edge, above 0; of the longest edge for `geodesic-N`. Not for boxes
    #[arg(long, value_name = "LENGTH", conflicts_with = "size")]
    #[serde(default)]
    pub edge: Option<Length>,
    /// Largest extent along x, y or z, above 0; 100mm when neither edge nor size is given. Not for
    /// boxes
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub size: Option<Length>,
}

impl Default for SolidParams {
    /// A cube of the default size.
    fn default() -> Self {
        Self { name: SolidName::Platonic(Platonic::Cube), edge: None, size: None }
    }
}

/// Makes the solid that `params` name: with the given edge length, or the given largest extent, or
/// 100 mm large.
///
/// # Errors
/// [`ShapeError`] when edge and size are both given, a length is not above zero, a box gets a
/// second size, or a number in the name is out of range.
pub fn solid(params: &SolidParams) -> Result<Mesh, ShapeError> {
    let size = SolidSize::from_options(params.edge, params.size)?;
    kerfold_kernel::shape::solid(params.name, size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{Args, FromArgMatches};

    #[test]
    fn flags_and_recipes_agree() {
        let command = SolidParams::augment_args(clap::Command::new("solid"));
        let flags = |words: &[&str]| {
            let matches = command.clone().try_get_matches_from([&["solid"], words].concat());
            matches.map(|m| SolidParams::from_arg_matches(&m).expect("the arguments fit"))
        };
        let recipe: SolidParams =
            toml::from_str("solid = \"prism-7\"\nedge = \"1/2in\"").expect("a recipe");
        assert_eq!(flags(&["prism-7", "--edge", "12.7mm"]).expect("flags"), recipe);
        assert_eq!(
            toml::from_str::<SolidParams>("name = \"cube\"").expect("a recipe"),
            flags(&["cube"]).expect("only a name")
        );
        assert!(flags(&["cube", "--edge", "1", "--size", "2"]).is_err());
        let error = flags(&["cubr"]).expect_err("no such solid");
        assert!(error.to_string().contains("did you mean `cube`?"), "{error}");
    }
}
