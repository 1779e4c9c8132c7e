//! The content of a PDF page: paths that are stroked or filled, text, forms, layers.

use glam::{DAffine2, DVec2};

use super::budget::{Budget, Cost};
use super::curve::Flattener;
use super::pdf_file::{Objects, PageNode};
use super::pdf_object::{Dict, Lexer, Object};
use super::pdf_unpack::unpack;
use super::svg_path::Subpaths;
use super::{ArtError, Collector, DEEPEST, Place};
use crate::geom::polygon::bounds;
use crate::lint::{Artwork, Operation, UnitState};

/// Millimetres in a point.
const POINT: f64 = 25.4 / 72.0;

/// What `q` saves.
#[derive(Clone)]
struct State {
    transform: DAffine2,
    stroke: [u8; 3],
    fill: [u8; 3],
    /// The box, on the page, outside of which nothing shows.
    clip: Option<(DVec2, DVec2)>,
}

/// States that may be saved at a time, layers that may be open, and values before an operator.
const MOST_OPEN: usize = 4096;

/// A layer, or other marked content.
#[derive(Clone, Default)]
struct Layer {
    /// Nothing for content that belongs to none.
    name: Option<String>,
    is_hidden: bool,
}

struct Painter<'a> {
    objects: &'a Objects,
    budget: &'a Budget,
    /// Numbers of the layers that are switched off.
    hidden: &'a [u32],
    out: Collector<'a>,
    /// The layers that are open, innermost last.
    layers: Vec<Layer>,
    /// Whether lines go on beyond what a clipping path shows: the page is a window on something
    /// larger.
    is_window: bool,
}

pub(super) fn page(
    objects: &Objects,
    node: &PageNode<'_>,
    hidden: &[u32],
    budget: &Budget,
) -> Result<Artwork, ArtError> {
    let (upright, size) = upright(objects, node)?;
    let state = State { transform: upright, stroke: [0; 3], fill: [0; 3], clip: None };
    let mut painter = Painter {
        objects,
        budget,
        hidden,
        out: Collector::new(budget),
        layers: Vec::new(),
        is_window: false,
    };
    let content = contents(objects, node, budget)?;
    let empty = Dict::new();
    let resources = node.entry(objects, "Resources").and_then(Object::dict).unwrap_or(&empty);
    painter.paint(&content, resources, state, 0)?;
    let size = Some(size).filter(|_| !painter.is_window);
    painter.out.finish(size, UnitState::Known)
}

/// From points of the page to millimetres, turned as it is looked at; and its size there.
fn upright(objects: &Objects, node: &PageNode<'_>) -> Result<(DAffine2, DVec2), ArtError> {
    let corners = match node.entry(objects, "MediaBox") {
        Some(Object::Array(items)) => {
            items.iter().filter_map(|o| objects.get(o).number()).collect()
        }
        _ => vec![0.0, 0.0, 612.0, 792.0],
    };
    let &[x, y, right, top] = corners.as_slice() else {
        return Err(ArtError::Pdf("a page has no size"));
    };
    let number = |name: &str| node.entry(objects, name).and_then(Object::number);
    let scale = POINT * number("UserUnit").filter(|u| *u > 0.0).unwrap_or(1.0);
    let low = DVec2::new(x.min(right), y.min(top));
    let mut size = DVec2::new((right - x).abs(), (top - y).abs()) * scale;
    let quarter = ((number("Rotate").unwrap_or(0.0) / 90.0).round() as i64).rem_euclid(4);
    let upright = DAffine2::from_scale(DVec2::splat(scale)) * DAffine2::from_translation(-low);
    // Pages are turned clockwise.
    let turned = match quarter {
        1 => DAffine2::from_cols_array(&[0.0, -1.0, 1.0, 0.0, 0.0, size.x]),
        2 => DAffine2::from_cols_array(&[-1.0, 0.0, 0.0, -1.0, size.x, size.y]),
        3 => DAffine2::from_cols_array(&[0.0, 1.0, -1.0, 0.0, size.y, 0.0]),
        _ => DAffine2::IDENTITY,
    };
    if quarter % 2 == 1 {
        size = DVec2::new(size.y, size.x);
    }
    Ok((turned * upright, size))
}

fn contents(objects: &Objects, node: &PageNode<'_>, budget: &Budget) -> Result<Vec<u8>, ArtError> {
    let streams: Vec<&Object> = match node.entry(objects, "Contents") {
        Some(Object::Array(items)) => items.iter().map(|o| objects.get(o)).collect(),
        Some(one) => vec![one],
        None => Vec::new(),
    };
    let mut bytes = Vec::new();
    for object in streams {
        if let Object::Stream(dict, raw) = object {
            bytes.extend(unpack(dict, raw, budget)?);
            bytes.push(b'\n');
        }
    }
    Ok(bytes)
}

/// A path that is being built, in user space.
#[derive(Default)]
struct Building {
    done: Subpaths,
    points: Vec<DVec2>,
}

impl Building {
    /// How many points it has so far.
    fn count(&self) -> usize {
        self.points.len() + self.done.iter().map(|(points, _)| points.len()).sum::<usize>()
    }

    fn finish(&mut self, closed: bool) {
        if !self.points.is_empty() {
            self.done.push((std::mem::take(&mut self.points), closed));
        }
    }
}

impl Painter<'_> {
    fn paint(
        &mut self,
        content: &[u8],
        resources: &Dict,
        state: State,
        depth: usize,
    ) -> Result<(), ArtError> {
        if depth > DEEPEST {
            return Err(ArtError::TooDeep);
        }
        let mut state = state;
        let mut saved = Vec::new();
        let mut stack: Vec<Object> = Vec::new();
        let mut path = Building::default();
        let mut text = TextState::default();
        let mut lexer = Lexer::new(content, 0, self.budget);
        loop {
            let Some(object) = lexer.object()? else {
                // A bracket too many is skipped.
                lexer.skip();
                if lexer.at >= content.len() {
                    break;
                }
                lexer.at += 1;
                continue;
            };
            let Object::Word(operator) = object else {
                stack.push(object);
                check_open(stack.len())?;
                continue;
            };
            let numbers: Vec<f64> = stack.iter().filter_map(Object::number).collect();
            match operator.as_str() {
                "q" => {
                    check_open(saved.len())?;
                    saved.push(state.clone());
                }
                "Q" => state = saved.pop().unwrap_or(state),
                "cm" => state.transform *= matrix(&numbers),
                "Do" => self.object(&stack, resources, &state, depth)?,
                "BI" => {
                    self.out.unread("image");
                    skip_image(&mut lexer);
                }
                "sh" => self.out.unread("shading"),
                "BDC" | "BMC" => {
                    check_open(self.layers.len())?;
                    let layer = self.layer(&stack, resources);
                    self.layers.push(layer);
                }
                "EMC" => drop(self.layers.pop()),
                _ if colour(&operator, &numbers, &mut state) => {}
                "Tj" | "'" | "\"" | "TJ" => self.show(&stack, &text, &state)?,
                _ if text.operate(&operator, &numbers) => {}
                "W" | "W*" => {
                    self.budget.spend(Cost::Steps, path.count())?;
                    state.clip = clipped(&path, &state);
                }
                _ => self.draw(&operator, &numbers, &mut path, &state)?,
            }
            stack.clear();
        }
        Ok(())
    }

    /// Building and painting of paths.
    fn draw(
        &mut self,
        operator: &str,
        n: &[f64],
        path: &mut Building,
        state: &State,
    ) -> Result<(), ArtError> {
        let at = |i: usize| {
            DVec2::new(n.get(i).copied().unwrap_or(0.0), n.get(i + 1).copied().unwrap_or(0.0))
        };
        let current = path.points.last().copied().unwrap_or_default();
        self.budget.spend(Cost::Points, 1)?;
        let flattener = Flattener::of(&state.transform, self.budget);
        match operator {
            "m" => {
                path.finish(false);
                path.points.push(at(0));
            }
            "l" => path.points.push(at(0)),
            "c" => flattener.cubic([current, at(0), at(2), at(4)], &mut path.points)?,
            "v" => flattener.cubic([current, current, at(0), at(2)], &mut path.points)?,
            "y" => flattener.cubic([current, at(0), at(2), at(2)], &mut path.points)?,
            "h" => close(path),
            "re" => {
                path.finish(false);
                let (low, size) = (at(0), at(2));
                let corners =
                    [low, low + DVec2::new(size.x, 0.0), low + size, low + DVec2::new(0.0, size.y)];
                path.done.push((corners.to_vec(), true));
            }
            "S" | "B" | "B*" => self.stroke(path, state, false)?,
            "s" | "b" | "b*" => {
                close(path);
                self.stroke(path, state, false)?;
            }
            "f" | "F" | "f*" => {
                // Filling closes.
                close(path);
                self.stroke(path, state, true)?;
            }
            "n" => *path = Building::default(),
            _ => {}
        }
        Ok(())
    }

    /// The name of the innermost layer, and whether what is drawn now is hidden.
    fn innermost(&self) -> (String, bool) {
        let name = self.layers.iter().rev().find_map(|layer| layer.name.clone());
        (name.unwrap_or_default(), self.layers.iter().any(|layer| layer.is_hidden))
    }

    fn stroke(
        &mut self,
        path: &mut Building,
        state: &State,
        is_filled: bool,
    ) -> Result<(), ArtError> {
        path.finish(false);
        self.budget.spend(Cost::Steps, self.layers.len())?;
        let (layer, is_hidden) = self.innermost();
        let operation = Operation::of_name(&layer);
        let colour = if is_filled { state.fill } else { state.stroke };
        for (points, closed) in std::mem::take(&mut path.done) {
            // A moved pen that draws nothing is nothing in a PDF.
            if points.len() < 2 {
                continue;
            }
            if is_hidden {
                self.out.unread("line on a layer that is off");
                continue;
            }
            let points: Vec<DVec2> =
                points.into_iter().map(|p| state.transform.transform_point2(p)).collect();
            if let Some((low, high)) = state.clip
                && let Some((from, to)) = bounds(&points)
            {
                self.is_window |= from.cmplt(low).any() || to.cmpgt(high).any();
            }
            let place = Place { layer: &layer, name: None, operation, colour };
            self.out.path((points, closed), &place)?;
        }
        Ok(())
    }

    /// Live text.
    fn show(&mut self, stack: &[Object], text: &TextState, state: &State) -> Result<(), ArtError> {
        let pieces = stack.iter().flat_map(|object| match object {
            Object::Array(items) => items.as_slice(),
            other => std::slice::from_ref(other),
        });
        let mut shown = String::new();
        for piece in pieces {
            if let Object::Text(bytes) = piece {
                shown += &String::from_utf8_lossy(bytes);
            }
        }
        let (layer, is_hidden) = self.innermost();
        if shown.trim().is_empty() || is_hidden {
            return Ok(());
        }
        let at = state.transform.transform_point2(text.line.translation);
        let operation = Operation::of_name(&layer);
        let place = Place { layer: &layer, name: None, operation, colour: state.fill };
        self.out.text(&shown, at, &place)
    }

    /// A form is content in content; an image is not judged.
    fn object(
        &mut self,
        stack: &[Object],
        resources: &Dict,
        state: &State,
        depth: usize,
    ) -> Result<(), ArtError> {
        let objects = self.objects;
        let name = stack.last().and_then(Object::name).unwrap_or_default();
        let found = objects
            .entry(resources, "XObject")
            .and_then(Object::dict)
            .and_then(|x| objects.entry(x, name));
        let Some(Object::Stream(dict, raw)) = found else { return Ok(()) };
        if objects.entry(dict, "Subtype").and_then(Object::name) != Some("Form") {
            self.out.unread("image");
            return Ok(());
        }
        let numbers: Vec<f64> = match objects.entry(dict, "Matrix") {
            Some(Object::Array(items)) => {
                items.iter().filter_map(|o| objects.get(o).number()).collect()
            }
            _ => Vec::new(),
        };
        self.budget.spend(Cost::Instances, 1)?;
        let mut inner = state.clone();
        inner.transform *= matrix(&numbers);
        let content = unpack(dict, raw, self.budget)?;
        let own = objects.entry(dict, "Resources").and_then(Object::dict).unwrap_or(resources);
        let open = self.layers.len();
        self.paint(&content, own, inner, depth + 1)?;
        self.layers.truncate(open);
        Ok(())
    }

    /// The optional content group that marked content belongs to.
    fn layer(&self, stack: &[Object], resources: &Dict) -> Layer {
        let [tag, property] = stack else { return Layer::default() };
        if tag.name() != Some("OC") {
            return Layer::default();
        }
        let properties = self.objects.entry(resources, "Properties").and_then(Object::dict);
        let group = properties.zip(property.name()).and_then(|(p, name)| p.get(name));
        let is_hidden = match group {
            Some(Object::Reference(id)) => self.hidden.binary_search(id).is_ok(),
            _ => false,
        };
        let dict = group.and_then(|group| self.objects.get(group).dict());
        let name = match dict.and_then(|group| self.objects.entry(group, "Name")) {
            Some(Object::Text(name)) => {
                // Nobody looks for longer ones.
                Some(String::from_utf8_lossy(&name[..name.len().min(200)]).into_owned())
            }
            _ => None,
        };
        Layer { name, is_hidden }
    }
}

/// Refuses what is opened again and again and never closed.
fn check_open(count: usize) -> Result<(), ArtError> {
    let what = "states, layers or operands that are open at a time";
    if count < MOST_OPEN { Ok(()) } else { Err(ArtError::TooMuch { what, limit: MOST_OPEN }) }
}

/// What shows after clipping by a path, too: what its box and the box before have in common.
fn clipped(path: &Building, state: &State) -> Option<(DVec2, DVec2)> {
    let points = path.done.iter().flat_map(|(points, _)| points).chain(&path.points);
    let points: Vec<DVec2> = points.map(|&p| state.transform.transform_point2(p)).collect();
    let (low, high) = bounds(&points)?;
    Some(state.clip.map_or((low, high), |(l, h)| (low.max(l), high.min(h))))
}

/// Closes the path that is being built; what is drawn on without a move begins where it began.
fn close(path: &mut Building) {
    path.finish(true);
}

fn matrix(numbers: &[f64]) -> DAffine2 {
    match numbers {
        &[a, b, c, d, e, f] => DAffine2::from_cols_array(&[a, b, c, d, e, f]),
        _ => DAffine2::IDENTITY,
    }
}

/// Sets a colour, if the operator is one that does.
fn colour(operator: &str, n: &[f64], state: &mut State) -> bool {
    let byte = |x: f64| (x.clamp(0.0, 1.0) * 255.0).round() as u8;
    let read = match *n {
        [g] => Some([byte(g); 3]),
        [r, g, b] => Some([byte(r), byte(g), byte(b)]),
        [c, m, y, k] => Some([c, m, y].map(|x| byte((1.0 - x) * (1.0 - k)))),
        _ => None,
    };
    match operator {
        "RG" | "G" | "K" | "SC" | "SCN" => state.stroke = read.unwrap_or(state.stroke),
        "rg" | "g" | "k" | "sc" | "scn" => state.fill = read.unwrap_or(state.fill),
        _ => return false,
    }
    true
}

/// Where text is written.
#[derive(Default)]
struct TextState {
    line: DAffine2,
}

impl TextState {
    /// Whether the operator is one of text; those that move it are carried out.
    fn operate(&mut self, operator: &str, n: &[f64]) -> bool {
        match operator {
            "BT" => self.line = DAffine2::IDENTITY,
            "Tm" => self.line = matrix(n),
            "Td" | "TD" => {
                if let &[x, y] = n {
                    self.line *= DAffine2::from_translation(DVec2::new(x, y));
                }
            }
            "ET" | "Tf" | "Tc" | "Tw" | "Tz" | "TL" | "Tr" | "Ts" | "T*" => {}
            _ => return false,
        }
        true
    }
}

/// Goes on after the `EI` of an inline image.
fn skip_image(lexer: &mut Lexer<'_>) {
    let rest = &lexer.bytes[lexer.at..];
    let is_end =
        |w: &[u8]| w[0].is_ascii_whitespace() && &w[1..3] == b"EI" && w[3].is_ascii_whitespace();
    lexer.at += rest.windows(4).position(is_end).map_or(rest.len(), |i| i + 3);
}
