//! The content of a PDF page: paths that are stroked or filled, text, forms, layers.

use glam::{DAffine2, DVec2};

use super::curve::Flattener;
use super::pdf::Objects;
use super::pdf_object::{Dict, Lexer, Object, unpack};
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

struct Painter<'a> {
    objects: &'a Objects,
    out: Collector,
    /// Names of the layers that are open, innermost last; content that belongs to none is marked,
    /// too.
    layers: Vec<Option<String>>,
    /// Whether lines go on beyond what a clipping path shows: the page is a window on something
    /// larger.
    is_window: bool,
}

pub(super) fn page(objects: &Objects, dict: &Dict) -> Result<Artwork, ArtError> {
    let corners = match objects.entry(dict, "MediaBox") {
        Some(Object::Array(items)) => {
            items.iter().filter_map(|o| objects.get(o).number()).collect()
        }
        _ => vec![0.0, 0.0, 612.0, 792.0],
    };
    let &[x, y, right, top] = corners.as_slice() else {
        return Err(ArtError::Pdf("a page has no size"));
    };
    let unit = objects
        .entry(dict, "UserUnit")
        .and_then(Object::number)
        .filter(|u| *u > 0.0)
        .unwrap_or(1.0);
    let scale = POINT * unit;
    let low = DVec2::new(x.min(right), y.min(top));
    let mut size = DVec2::new((right - x).abs(), (top - y).abs()) * scale;
    let quarter = objects.entry(dict, "Rotate").and_then(Object::number).unwrap_or(0.0) / 90.0;
    let quarter = (quarter.round() as i64).rem_euclid(4);
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
    let state = State { transform: turned * upright, stroke: [0; 3], fill: [0; 3], clip: None };
    let mut painter =
        Painter { objects, out: Collector::default(), layers: Vec::new(), is_window: false };
    let content = contents(objects, dict)?;
    let empty = Dict::new();
    let resources = objects.entry(dict, "Resources").and_then(Object::dict).unwrap_or(&empty);
    painter.paint(&content, resources, state, 0)?;
    let size = Some(size).filter(|_| !painter.is_window);
    Ok(painter.out.finish(size, UnitState::Known))
}

fn contents(objects: &Objects, dict: &Dict) -> Result<Vec<u8>, ArtError> {
    let streams: Vec<&Object> = match objects.entry(dict, "Contents") {
        Some(Object::Array(items)) => items.iter().map(|o| objects.get(o)).collect(),
        Some(one) => vec![one],
        None => Vec::new(),
    };
    let mut bytes = Vec::new();
    for object in streams {
        if let Object::Stream(dict, raw) = object {
            bytes.extend(unpack(dict, raw).map_err(ArtError::Pdf)?);
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
        let mut lexer = Lexer { bytes: content, at: 0 };
        loop {
            let Some(object) = lexer.object() else {
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
                continue;
            };
            let numbers: Vec<f64> = stack.iter().filter_map(Object::number).collect();
            match operator.as_str() {
                "q" => saved.push(state.clone()),
                "Q" => state = saved.pop().unwrap_or(state),
                "cm" => state.transform *= matrix(&numbers),
                "Do" => self.object(&stack, resources, &state, depth)?,
                "BI" => {
                    self.out.unread("image");
                    skip_image(&mut lexer);
                }
                "sh" => self.out.unread("shading"),
                "BDC" | "BMC" => {
                    let layer = self.layer(&stack, resources);
                    self.layers.push(layer);
                }
                "EMC" => drop(self.layers.pop()),
                _ if colour(&operator, &numbers, &mut state) => {}
                _ if text.operate(&operator, &numbers, &stack, &state, &mut self.out) => {}
                "W" | "W*" => state.clip = clipped(&path, &state),
                _ => self.draw(&operator, &numbers, &mut path, &state),
            }
            stack.clear();
        }
        Ok(())
    }

    /// Building and painting of paths.
    fn draw(&mut self, operator: &str, n: &[f64], path: &mut Building, state: &State) {
        let at = |i: usize| {
            DVec2::new(n.get(i).copied().unwrap_or(0.0), n.get(i + 1).copied().unwrap_or(0.0))
        };
        let current = path.points.last().copied().unwrap_or_default();
        let flattener = Flattener::of(&state.transform);
        match operator {
            "m" => {
                path.finish(false);
                path.points.push(at(0));
            }
            "l" => path.points.push(at(0)),
            "c" => flattener.cubic([current, at(0), at(2), at(4)], &mut path.points),
            "v" => flattener.cubic([current, current, at(0), at(2)], &mut path.points),
            "y" => flattener.cubic([current, at(0), at(2), at(2)], &mut path.points),
            "h" => close(path),
            "re" => {
                path.finish(false);
                let (low, size) = (at(0), at(2));
                let corners =
                    [low, low + DVec2::new(size.x, 0.0), low + size, low + DVec2::new(0.0, size.y)];
                path.done.push((corners.to_vec(), true));
            }
            "S" | "B" | "B*" => self.stroke(path, state, false),
            "s" | "b" | "b*" => {
                close(path);
                self.stroke(path, state, false);
            }
            "f" | "F" | "f*" => {
                // Filling closes.
                close(path);
                self.stroke(path, state, true);
            }
            "n" => *path = Building::default(),
            _ => {}
        }
    }

    fn stroke(&mut self, path: &mut Building, state: &State, is_filled: bool) {
        path.finish(false);
        let told = self.layers.iter().rev().flatten().next().cloned().unwrap_or_default();
        let operation = Operation::of_name(&told);
        let colour = if is_filled { state.fill } else { state.stroke };
        for (points, closed) in std::mem::take(&mut path.done) {
            // A moved pen that draws nothing is nothing in a PDF.
            if points.len() < 2 {
                continue;
            }
            let points: Vec<DVec2> =
                points.into_iter().map(|p| state.transform.transform_point2(p)).collect();
            if let Some((low, high)) = state.clip
                && let Some((from, to)) = bounds(&points)
            {
                self.is_window |= from.cmplt(low).any() || to.cmpgt(high).any();
            }
            self.out.path((points, closed), &Place { layer: &told, name: None, operation, colour });
        }
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
        let mut inner = state.clone();
        inner.transform *= matrix(&numbers);
        let content = unpack(dict, raw).map_err(ArtError::Pdf)?;
        let own = objects.entry(dict, "Resources").and_then(Object::dict).unwrap_or(resources);
        let open = self.layers.len();
        self.paint(&content, own, inner, depth + 1)?;
        self.layers.truncate(open);
        Ok(())
    }

    /// The name of the optional content group that marked content belongs to.
    fn layer(&self, stack: &[Object], resources: &Dict) -> Option<String> {
        let [tag, property] = stack else { return None };
        if tag.name() != Some("OC") {
            return None;
        }
        let properties = self.objects.entry(resources, "Properties").and_then(Object::dict)?;
        let group = self.objects.entry(properties, property.name()?).and_then(Object::dict)?;
        match self.objects.entry(group, "Name") {
            Some(Object::Text(name)) => Some(String::from_utf8_lossy(name).into_owned()),
            _ => None,
        }
    }
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
    fn operate(
        &mut self,
        operator: &str,
        n: &[f64],
        stack: &[Object],
        state: &State,
        out: &mut Collector,
    ) -> bool {
        match operator {
            "BT" => self.line = DAffine2::IDENTITY,
            "Tm" => self.line = matrix(n),
            "Td" | "TD" => {
                if let &[x, y] = n {
                    self.line *= DAffine2::from_translation(DVec2::new(x, y));
                }
            }
            "Tj" | "'" | "\"" | "TJ" => {
                let mut shown = String::new();
                let mut show = |o: &Object| {
                    if let Object::Text(bytes) = o {
                        shown += &String::from_utf8_lossy(bytes);
                    }
                };
                for object in stack {
                    match object {
                        Object::Array(items) => items.iter().for_each(&mut show),
                        other => show(other),
                    }
                }
                if !shown.trim().is_empty() {
                    out.text(shown, state.transform.transform_point2(self.line.translation));
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
