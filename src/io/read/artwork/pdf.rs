//! PDF: the pages in order, with what is switched off.

use super::budget::{Budget, Cost};
use super::pdf_file::{Objects, PageNode};
use super::pdf_object::{Dict, Object};
use super::pdf_page::page;
use super::{ArtError, DEEPEST};
use crate::lint::Artwork;

pub(super) fn read(bytes: &[u8], budget: &Budget) -> Result<Vec<Artwork>, ArtError> {
    let objects = Objects::of_file(bytes, budget)?;
    let root = objects.catalogue();
    let root = root.ok_or(ArtError::Pdf("it has no catalogue; export the drawing again"))?;
    let hidden = hidden_layers(&objects, root);
    let mut pages = Vec::new();
    let top = objects.entry(root, "Pages").and_then(Object::dict);
    let top = PageNode::top(top.ok_or(ArtError::Pdf("it has no pages"))?);
    collect(&objects, &top, &mut pages, (budget, 0))?;
    if pages.is_empty() {
        return Err(ArtError::Pdf("it has no pages"));
    }
    pages.iter().map(|node| page(&objects, node, &hidden, budget)).collect()
}

/// Numbers of the optional content groups that are switched off.
fn hidden_layers(objects: &Objects, root: &Dict) -> Vec<u32> {
    let default = objects
        .entry(root, "OCProperties")
        .and_then(Object::dict)
        .and_then(|properties| objects.entry(properties, "D"))
        .and_then(Object::dict);
    let off = default.and_then(|d| objects.entry(d, "OFF"));
    let Some(Object::Array(groups)) = off else { return Vec::new() };
    let number = |o: &Object| if let Object::Reference(id) = o { Some(*id) } else { None };
    let mut numbers: Vec<u32> = groups.iter().filter_map(number).collect();
    numbers.sort_unstable();
    numbers
}

/// The pages below a node.
fn collect<'a>(
    objects: &'a Objects,
    node: &PageNode<'a>,
    pages: &mut Vec<PageNode<'a>>,
    (budget, depth): (&Budget, usize),
) -> Result<(), ArtError> {
    if depth > DEEPEST {
        return Err(ArtError::TooDeep);
    }
    budget.spend(Cost::Instances, 1)?;
    let Some(kids) = node.kids(objects) else {
        budget.spend(Cost::Pages, 1)?;
        pages.push(node.clone());
        return Ok(());
    };
    kids.iter().try_for_each(|kid| collect(objects, kid, pages, (budget, depth + 1)))
}
