//! 3MF, the files of 3D printing: the triangles of everything that is to be built.
//!
//! A file is a zip of XML parts. The unit of the model is used whatever `--units` says; z is up
//! already. Objects are placed as items and components say, mirrored ones turned right side out, and
//! keep their vertices as they are numbered. The group of a triangle is the name of its object, or
//! of the next one around it that has a name; where the triangles of an object have several
//! materials, it is the name of the material. Parts in other files of the zip (the production
//! extension, as slicers write it) are followed. Supports and what else is not to be built are left
//! out and noted.
//!
//! Source: the 3MF core specification 1.3 and the production extension 1.1 of the 3MF Consortium.

use std::collections::HashMap;
use std::rc::Rc;

use glam::DMat4;

use super::ReadNote;
use super::raw::{GroupRun, RawMesh};
use crate::io::error::{ContentFault, Located};
use model::{Model, Object, Placed};
use package::Package;

mod model;
mod package;
#[cfg(test)]
mod tests;

pub(super) use package::is_zip;

/// A small file can place one object many times: so many corners and components are read at most.
const MOST: usize = 16_000_000;
/// Components within components.
const DEEPEST: usize = 32;

/// What we call the material of faces without a group.
const NO_GROUP: &str = "default";
const SUPPORTS: &str = "objects that are supports or not to be built";
const BEAMS: &str = "lattices of beams";

pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Located> {
    let build = || {
        let mut package = Package::open(bytes)?;
        let root = package.root()?;
        let model = Model::parse(&package.text(&root)?, &root)?;
        let mut build = Build {
            raw: RawMesh { own_unit: Some(model.unit), ..RawMesh::default() },
            items: model.items.clone(),
            models: HashMap::from([(root.clone(), model)]),
            package,
            supports: 0,
            beams: 0,
            spent: 0,
        };
        build.take_items(&root)?;
        Ok(build)
    };
    let Build { mut raw, supports, beams, .. } = build().map_err(Located::anywhere)?;
    for (count, what) in [(supports, SUPPORTS), (beams, BEAMS)] {
        raw.notes.extend((count > 0).then_some(ReadNote::LeftOut { count, what }));
    }
    Ok(raw)
}

/// What is built, in the making.
struct Build<'a> {
    package: Package<'a>,
    /// The parts that were read, by their paths.
    models: HashMap<String, Model>,
    items: Vec<Placed>,
    raw: RawMesh,
    supports: usize,
    beams: usize,
    spent: usize,
}

/// An object that is to be placed.
struct Open {
    path: Rc<str>,
    object: u32,
    place: DMat4,
    name: Option<Rc<str>>,
    depth: usize,
}

impl Build<'_> {
    fn take_items(&mut self, root: &str) -> Result<(), ContentFault> {
        for item in std::mem::take(&mut self.items) {
            let whole =
                Open { path: root.into(), object: 0, place: DMat4::IDENTITY, name: None, depth: 0 };
            let mut open = vec![below(&whole, &item, None)];
            while let Some(next) = open.pop() {
                self.load(&next.path)?;
                let object = self.models.get(&*next.path).and_then(|m| m.objects.get(&next.object));
                let Some(object) = object else {
                    let Open { path, object, .. } = next;
                    return Err(broken(format!("object {object} of {path} is not there")));
                };
                if next.depth > DEEPEST {
                    return Err(broken(format!("object {} lies too deep in others", next.object)));
                }
                self.spent += 1 + object.components.len() + object.size();
                if self.spent > MOST {
                    return Err(ContentFault::TooMuchMesh { most: MOST });
                }
                if object.is_extra {
                    self.supports += 1;
                    continue;
                }
                self.beams += usize::from(object.has_beams);
                let own = object.name.as_deref().map(Rc::from);
                let name: Option<Rc<str>> = own.or(next.name.clone());
                take_object(&mut self.raw, object, &next, name.as_deref());
                open.extend(object.components.iter().rev().map(|c| below(&next, c, name.clone())));
            }
        }
        Ok(())
    }

    /// Reads a part, unless that was done.
    fn load(&mut self, path: &str) -> Result<(), ContentFault> {
        if !self.models.contains_key(path) {
            let model = Model::parse(&self.package.text(path)?, path)?;
            if self.raw.own_unit != Some(model.unit) {
                return Err(broken(format!("{path} has another unit than the model")));
            }
            self.models.insert(path.to_owned(), model);
        }
        Ok(())
    }
}

/// What an object places, where it places it.
fn below(above: &Open, placed: &Placed, name: Option<Rc<str>>) -> Open {
    Open {
        path: placed.path.as_deref().map_or_else(|| above.path.clone(), Rc::from),
        object: placed.object,
        place: above.place * placed.transform,
        name,
        depth: above.depth + 1,
    }
}

fn take_object(raw: &mut RawMesh, object: &Object, at: &Open, name: Option<&str>) {
    let start = raw.positions.len() as u32;
    let is_placed = at.place != DMat4::IDENTITY;
    // What is not moved keeps every digit.
    let place = |&p| if is_placed { at.place.transform_point3(p) } else { p };
    raw.positions.extend(object.positions.iter().map(place));
    let is_mirrored = at.place.determinant() < 0.0;
    let is_mixed = object.runs.len() > 1;
    let mut runs = object.runs.iter().peekable();
    for (i, &[a, b, c]) in object.triangles.iter().enumerate() {
        if let Some(run) = runs.next_if(|run| run.first == i) {
            let material = run.material.as_deref().filter(|&name| name != NO_GROUP);
            let name = if is_mixed { material.or(name) } else { name.or(material) };
            let (first_face, name) = (raw.ends.len(), name.map(str::to_owned));
            raw.groups.push(GroupRun { first_face, name, is_made: false });
        }
        let corners = if is_mirrored { [a, c, b] } else { [a, b, c] };
        raw.push_face(corners.map(|corner| start + corner));
    }
}

fn broken(what: impl Into<String>) -> ContentFault {
    ContentFault::BrokenParts { format: "3MF", what: what.into() }
}
