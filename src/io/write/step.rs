//! Plates as STEP (ISO 10303-21, AP214): one product with one named solid for each plate, in
//! millimetres.
//!
//! Every solid is an advanced boundary representation: planes bounded by lines, and round holes as
//! cylinders between two circles with one seam. Numbers have all their digits, so the surfaces meet
//! to rounding.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::DVec3;

use super::plates::NamedPlate;
use crate::panel::{Hole, Plate, Solid, SolidFace, SolidSide};

/// The bytes of the file; `command` is the command line that made it.
pub fn step_bytes(parts: &[NamedPlate<'_>], command: &str) -> Vec<u8> {
    let mut step = StepFile { text: header(command), next: 1 };
    let context = step.context();
    let mut products = Vec::new();
    for part in parts {
        products.push(step.part(part, &context));
    }
    if !products.is_empty() {
        step.add(&format!("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,({}))", list(&products)));
    }
    step.text += "ENDSEC;\nEND-ISO-10303-21;\n";
    step.text.into_bytes()
}

fn header(command: &str) -> String {
    format!(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(({}),'2;1');\n\
         FILE_NAME('plates.step','',(''),(''),'kerfold','kerfold','');\n\
         FILE_SCHEMA(('AUTOMOTIVE_DESIGN {{ 1 0 10303 214 1 1 1 1 }}'));\nENDSEC;\nDATA;\n",
        quoted(command)
    )
}

/// What all products share.
struct Context {
    product: usize,
    definition: usize,
    geometry: usize,
    placement: usize,
}

struct StepFile {
    text: String,
    next: usize,
}

impl StepFile {
    fn add(&mut self, entity: &str) -> usize {
        let id = self.next;
        self.next += 1;
        let _ = writeln!(self.text, "#{id}={entity};");
        id
    }

    fn context(&mut self) -> Context {
        let application = self.add("APPLICATION_CONTEXT('automotive design')");
        self.add(&format!(
            "APPLICATION_PROTOCOL_DEFINITION('international \
            standard','automotive_design',2000,#{application})"
        ));
        let product = self.add(&format!("PRODUCT_CONTEXT('',#{application},'mechanical')"));
        let definition = self
            .add(&format!("PRODUCT_DEFINITION_CONTEXT('part definition',#{application},'design')"));
        let length = self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
        let angle = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
        let solid_angle = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
        let uncertainty = self.add(&format!(
            "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-6),#{length},'distance_accuracy_value','')"
        ));
        let geometry = self.add(&format!(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{uncertainty}))\
             GLOBAL_UNIT_ASSIGNED_CONTEXT((#{length},#{angle},#{solid_angle}))REPRESENTATION_CONTEXT('',''))"
        ));
        let placement = self.placement(DVec3::ZERO, DVec3::Z, DVec3::X);
        Context { product, definition, geometry, placement }
    }

    /// A product with its solid; gives the product.
    fn part(&mut self, part: &NamedPlate<'_>, context: &Context) -> usize {
        let name = quoted(&part.name);
        let body = self.solid(part.plate, part.body, &name);
        let shape = self.add(&format!(
            "ADVANCED_BREP_SHAPE_REPRESENTATION({name},(#{},#{body}),#{})",
            context.placement, context.geometry
        ));
        let product = self.add(&format!("PRODUCT({name},{name},'',(#{}))", context.product));
        let formation = self.add(&format!("PRODUCT_DEFINITION_FORMATION('','',#{product})"));
        let definition = self
            .add(&format!("PRODUCT_DEFINITION('design','',#{formation},#{})", context.definition));
        let defined = self.add(&format!("PRODUCT_DEFINITION_SHAPE('','',#{definition})"));
        self.add(&format!("SHAPE_DEFINITION_REPRESENTATION(#{defined},#{shape})"));
        product
    }

    /// The body of a plate. Its round holes are cylinders, so of the faces of the body, in which
    /// they are polygons, only those around the plate are taken.
    fn solid(&mut self, plate: &Plate, body: &Solid, name: &str) -> usize {
        let corners = 2 * plate.front.len();
        let points = &body.points[..corners];
        let vertices = points.iter().map(|&p| self.vertex(p)).collect();
        let mut wires = Wires { points, vertices, edges: BTreeMap::new() };
        let bores: Vec<Bore> = plate.holes.iter().map(|hole| self.bore(plate, hole)).collect();
        let mut faces = Vec::new();
        for face in body.faces.iter().filter(|face| face.side != SolidSide::Bore) {
            faces.push(self.flat_face(face, &mut wires, &bores));
        }
        for bore in &bores {
            let round =
                [(bore.front, true), (bore.seam, false), (bore.back, false), (bore.seam, true)];
            let bound = self.bound("FACE_OUTER_BOUND", &round);
            faces.push(self.add(&format!("ADVANCED_FACE('',(#{bound}),#{},.F.)", bore.surface)));
        }
        let shell = self.add(&format!("CLOSED_SHELL('',({}))", list(&faces)));
        self.add(&format!("MANIFOLD_SOLID_BREP({name},#{shell})"))
    }

    /// A face of front, back or a cut, with the circles of the holes where they open.
    fn flat_face(&mut self, face: &SolidFace, wires: &mut Wires<'_>, bores: &[Bore]) -> usize {
        let n = face.outline.len();
        let sides = (0..n).map(|i| [face.outline[i], face.outline[(i + 1) % n]]);
        let around: Vec<(usize, bool)> = sides.map(|side| self.edge(side, wires)).collect();
        let mut bounds = vec![self.bound("FACE_OUTER_BOUND", &around)];
        for bore in bores {
            let circle = match face.side {
                SolidSide::Front => (bore.front, false),
                SolidSide::Back => (bore.back, true),
                SolidSide::Cut | SolidSide::Bore => continue,
            };
            bounds.push(self.bound("FACE_BOUND", &[circle]));
        }
        let [a, b] = [0, 1].map(|i| wires.points[face.outline[i] as usize]);
        let placement = self.placement(a, face.normal, b - a);
        let plane = self.add(&format!("PLANE('',#{placement})"));
        self.add(&format!("ADVANCED_FACE('',({}),#{plane},.T.)", list(&bounds)))
    }

    /// The edge between two corners, made at its first use, and whether it runs from the first to
    /// the second.
    fn edge(&mut self, [a, b]: [u32; 2], wires: &mut Wires<'_>) -> (usize, bool) {
        let key = [a.min(b), a.max(b)];
        let edge = match wires.edges.get(&key) {
            Some(&edge) => edge,
            None => {
                let [from, to] = key.map(|i| wires.vertices[i as usize]);
                let [p, q] = key.map(|i| wires.points[i as usize]);
                let edge = self.line(from, to, p, q);
                wires.edges.insert(key, edge);
                edge
            }
        };
        (edge, a < b)
    }

    /// The circles, seam and cylinder of a round hole.
    fn bore(&mut self, plate: &Plate, hole: &Hole) -> Bore {
        let (axis, x) = (plate.frame.normal, plate.frame.x);
        let [front, back] = [plate.on_front(hole.centre), plate.on_back(hole.centre)];
        let on_circle = |centre: DVec3| centre + x * hole.radius;
        let [front_vertex, back_vertex] =
            [front, back].map(|centre| self.vertex(on_circle(centre)));
        let mut circle = |vertex: usize, centre: DVec3| {
            let placement = self.placement(centre, axis, x);
            let circle = self.add(&format!("CIRCLE('',#{placement},{})", real(hole.radius)));
            self.add(&format!("EDGE_CURVE('',#{vertex},#{vertex},#{circle},.T.)"))
        };
        let (front_edge, back_edge) = (circle(front_vertex, front), circle(back_vertex, back));
        let seam = self.line(back_vertex, front_vertex, on_circle(back), on_circle(front));
        let placement = self.placement(back, axis, x);
        let surface =
            self.add(&format!("CYLINDRICAL_SURFACE('',#{placement},{})", real(hole.radius)));
        Bore { front: front_edge, back: back_edge, seam, surface }
    }

    fn bound(&mut self, kind: &str, edges: &[(usize, bool)]) -> usize {
        let oriented: Vec<usize> = edges
            .iter()
            .map(|&(edge, forward)| {
                let sense = if forward { ".T." } else { ".F." };
                self.add(&format!("ORIENTED_EDGE('',*,*,#{edge},{sense})"))
            })
            .collect();
        let edge_loop = self.add(&format!("EDGE_LOOP('',({}))", list(&oriented)));
        self.add(&format!("{kind}('',#{edge_loop},.T.)"))
    }

    /// A straight edge from `p` to `q`.
    fn line(&mut self, from: usize, to: usize, p: DVec3, q: DVec3) -> usize {
        let point = self.point(p);
        let direction = self.direction(q - p);
        let vector = self.add(&format!("VECTOR('',#{direction},1.)"));
        let line = self.add(&format!("LINE('',#{point},#{vector})"));
        self.add(&format!("EDGE_CURVE('',#{from},#{to},#{line},.T.)"))
    }

    fn vertex(&mut self, p: DVec3) -> usize {
        let point = self.point(p);
        self.add(&format!("VERTEX_POINT('',#{point})"))
    }

    fn point(&mut self, p: DVec3) -> usize {
        self.add(&format!("CARTESIAN_POINT('',({}))", reals(p)))
    }

    fn direction(&mut self, d: DVec3) -> usize {
        self.add(&format!("DIRECTION('',({}))", reals(d.normalize_or(DVec3::X))))
    }

    fn placement(&mut self, origin: DVec3, axis: DVec3, x: DVec3) -> usize {
        let [origin, axis, x] = [self.point(origin), self.direction(axis), self.direction(x)];
        self.add(&format!("AXIS2_PLACEMENT_3D('',#{origin},#{axis},#{x})"))
    }
}

/// The corners and edges of a body that are shared by its faces, with their entities.
struct Wires<'a> {
    points: &'a [DVec3],
    vertices: Vec<usize>,
    edges: BTreeMap<[u32; 2], usize>,
}

/// The entities of a round hole.
struct Bore {
    front: usize,
    back: usize,
    seam: usize,
    surface: usize,
}

fn list(ids: &[usize]) -> String {
    ids.iter().map(|id| format!("#{id}")).collect::<Vec<_>>().join(",")
}

fn reals(p: DVec3) -> String {
    p.to_array().map(real).join(",")
}

/// A number with its point, as STEP wants it: `1.`, `2.5`, `1.E-7`.
fn real(value: f64) -> String {
    // Never −0.
    let text = format!("{:?}", value + 0.0);
    match text.split_once('e') {
        Some((digits, exponent)) if digits.contains('.') => format!("{digits}E{exponent}"),
        Some((digits, exponent)) => format!("{digits}.E{exponent}"),
        None => text,
    }
}

/// A text in quotes; what is not plain ASCII in the long form.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("'");
    for c in text.chars() {
        match c {
            '\'' => quoted += "''",
            '\\' => quoted += "\\\\",
            ' '..='~' => quoted.push(c),
            c if c.is_control() => quoted.push(' '),
            c => {
                let _ = write!(quoted, "\\X4\\{:08X}\\X0\\", c as u32);
            }
        }
    }
    quoted + "'"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Frame;
    use crate::mesh::{EdgeId, FaceId};
    use crate::panel::solid;
    use glam::DVec2;

    #[test]
    fn numbers_have_a_point() {
        for (value, text) in
            [(1.0, "1.0"), (1e-7, "1.E-7"), (2.5e-9, "2.5E-9"), (-0.0, "0.0"), (1e22, "1.E22")]
        {
            assert_eq!(real(value), text);
        }
    }

    #[test]
    fn every_number_that_is_used_is_defined_and_every_edge_has_two_sides() {
        let hole = |at: DVec2| Hole { centre: at, radius: 1.0, edge: EdgeId::new(0) };
        let square = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)].map(DVec2::from).to_vec();
        let plate = Plate {
            face: FaceId::new(0),
            thickness: 2.0,
            frame: Frame { origin: DVec3::ZERO, x: DVec3::X, y: DVec3::Y, normal: DVec3::Z },
            half_edges: vec![],
            reference: square.clone(),
            back: square
                .iter()
                .map(|&p| DVec2::splat(10.0) + (p - DVec2::splat(10.0)) * 0.8)
                .collect(),
            blank: square.clone(),
            inner: square.clone(),
            front: square,
            begins: vec![0, 1, 2, 3],
            ends: vec![1, 2, 3, 0],
            holes: vec![hole(DVec2::new(5.0, 5.0)), hole(DVec2::new(15.0, 5.0))],
        };
        let body = solid(&plate).expect("closed");
        let named =
            NamedPlate { name: "P01".to_owned(), group: 0, plate: &plate, body: &body, row: None };
        let bytes = step_bytes(&[named], "kerfold panels");
        let text = String::from_utf8(bytes).expect("ASCII");
        let ids = |line: &str| -> Vec<usize> {
            let digits = |t: &str| {
                t.split(|c: char| !c.is_ascii_digit()).next().and_then(|d| d.parse().ok())
            };
            line.split('#').skip(1).filter_map(digits).collect()
        };
        let mut defined = std::collections::BTreeSet::new();
        for line in text.lines().filter(|l| l.starts_with('#')) {
            let ids = ids(line);
            assert!(ids[1..].iter().all(|id| defined.contains(id)), "{line}");
            assert!(defined.insert(ids[0]), "{line}");
        }
        let count = |word: &str| text.matches(word).count();
        assert_eq!(
            (count("ADVANCED_FACE("), count("CYLINDRICAL_SURFACE("), count("PLANE('',#")),
            (6 + 2, 2, 6)
        );
        assert_eq!(count("ORIENTED_EDGE("), 2 * count("EDGE_CURVE("));
    }

    #[test]
    fn texts_are_plain_ascii() {
        assert_eq!(quoted("it's ½\n"), "'it''s \\X4\\000000BD\\X0\\ '");
    }
}
