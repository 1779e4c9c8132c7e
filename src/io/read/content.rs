//! Which mesh format a content has, for files whose name does not say.

use super::{glb, off, stl, threemf};
use crate::io::format::MeshFormat;

impl MeshFormat {
    /// The format that the content shows, for files whose name does not.
    pub fn of_content(bytes: &[u8]) -> Option<Self> {
        if glb::is_glb(bytes) {
            return Some(Self::Glb);
        }
        if threemf::is_zip(bytes) {
            return Some(Self::ThreeMf);
        }
        let start = &bytes[..bytes.len().min(4096)];
        let mut words = start.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let is_stl = |word: &[u8]| {
            [&b"solid"[..], b"facet"].iter().any(|name| word.eq_ignore_ascii_case(name))
        };
        match words.next()? {
            b"ply" => Some(Self::Ply),
            _ if stl::is_binary(bytes) => Some(Self::Stl),
            word if off::begins_off(word) => Some(Self::Off),
            word if is_stl(word) && words.any(|word| word.eq_ignore_ascii_case(b"vertex")) => {
                Some(Self::Stl)
            }
            _ => start
                .split(|&b| b == b'\n')
                .any(|line| line.starts_with(b"v "))
                .then_some(Self::Obj),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contents_show_the_format() {
        let holds = |text: &str| MeshFormat::of_content(text.as_bytes());
        assert_eq!(holds("ply\r\nformat ascii 1.0"), Some(MeshFormat::Ply));
        assert_eq!(holds("OFF 8 6 12\n"), Some(MeshFormat::Off));
        assert_eq!(holds("OFF8 6 12\n"), Some(MeshFormat::Off));
        assert_eq!(holds("glTF\u{2}\0\0\0"), Some(MeshFormat::Glb));
        assert_eq!(holds("PK\u{3}\u{4}"), Some(MeshFormat::ThreeMf));
        assert_eq!(holds("OFFICE\n"), None);
        assert_eq!(holds("# made by hand\nv 0 0 0\n"), Some(MeshFormat::Obj));
        assert_eq!(
            holds("solid x\n facet normal 0 0 1\n outer loop\n vertex 0 0 0"),
            Some(MeshFormat::Stl)
        );
        assert_eq!(holds("hello"), None);
        assert_eq!(holds(""), None);
    }
}
