//! Which mesh format a file has.

use std::fmt;
use std::path::Path;

/// A format of mesh files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MeshFormat {
    /// Wavefront OBJ: polygons, groups, seams.
    Obj,
    /// Stanford PLY: polygons, text or binary.
    Ply,
    /// STL: triangles without shared vertices, text or binary.
    Stl,
    /// Object File Format: polygons, text.
    Off,
    /// Binary glTF: triangles in a scene; read only.
    Glb,
    /// 3MF: triangles with a unit, groups as materials.
    ThreeMf,
    /// DXF: faces with a layer for each group; written only.
    Dxf,
}

impl fmt::Display for MeshFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::Off => "OFF",
            Self::Glb => "GLB",
            Self::ThreeMf => "3MF",
            Self::Dxf => "DXF",
        })
    }
}

impl MeshFormat {
    /// The format that the name shows, by its extension in any case; `-` (a standard stream) is
    /// OBJ.
    pub fn of_path(path: &Path) -> Option<Self> {
        if path.as_os_str() == "-" {
            return Some(Self::Obj);
        }
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "stl" => Some(Self::Stl),
            "off" => Some(Self::Off),
            "glb" => Some(Self::Glb),
            "3mf" => Some(Self::ThreeMf),
            "dxf" => Some(Self::Dxf),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_show_the_format() {
        let named = |name: &str| MeshFormat::of_path(Path::new(name));
        assert_eq!(named("a/b.OBJ"), Some(MeshFormat::Obj));
        assert_eq!(named("-"), Some(MeshFormat::Obj));
        assert_eq!(named("x.stl"), Some(MeshFormat::Stl));
        assert_eq!(named("x.Glb"), Some(MeshFormat::Glb));
        assert_eq!(named("x.step"), None);
        assert_eq!(named("obj"), None);
    }
}
