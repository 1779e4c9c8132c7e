//! The five Platonic and thirteen Archimedean solids, from closed-form coordinates.
//!
//! The vertices of each solid are orbits of a few seed points under permutations and signs of the
//! coordinates (Coxeter 1973, "Regular Polytopes"; Cromwell 1997, "Polyhedra"), so each coordinate
//! is right to an ulp or two. The faces follow from the vertices: neighbours are the points at the
//! least distance, and each face is the walk that turns left at every vertex.

use glam::DVec3;

use super::Raw;

/// The golden ratio φ.
const PHI: f64 = 1.618_033_988_749_895;
/// The tribonacci constant: t³ = t² + t + 1.
const TRIBONACCI: f64 = 1.839_286_755_214_161_1;
/// The real root of ξ³ = 2ξ + φ.
const XI: f64 = 1.715_561_499_697_367_8;

/// A regular solid: one kind of face, one kind of vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Platonic {
    /// 4 triangles, three at a vertex.
    Tetrahedron,
    /// 6 squares, three at a vertex; parallel to the axes.
    Cube,
    /// 8 triangles, four at a vertex; vertices on the axes.
    Octahedron,
    /// 12 pentagons, three at a vertex.
    Dodecahedron,
    /// 20 triangles, five at a vertex.
    Icosahedron,
}

/// A solid with regular faces of several kinds and one kind of vertex, prisms and antiprisms left
/// out.
///
/// The two snub solids differ from their mirror images. Both are made in the same hand: seen from
/// outside and looking across a side of a square (pentagon) away from its middle, the nearest
/// square (pentagon) beyond lies to the right. Their mirror images are not offered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Archimedean {
    /// Vertices 3.6.6.
    TruncatedTetrahedron,
    /// Vertices 3.4.3.4.
    Cuboctahedron,
    /// Vertices 3.8.8.
    TruncatedCube,
    /// Vertices 4.6.6.
    TruncatedOctahedron,
    /// Vertices 3.4.4.4.
    Rhombicuboctahedron,
    /// Vertices 4.6.8.
    TruncatedCuboctahedron,
    /// Vertices 3.3.3.3.4; chiral.
    SnubCube,
    /// Vertices 3.5.3.5.
    Icosidodecahedron,
    /// Vertices 3.10.10.
    TruncatedDodecahedron,
    /// Vertices 5.6.6: the soccer ball.
    TruncatedIcosahedron,
    /// Vertices 3.4.5.4.
    Rhombicosidodecahedron,
    /// Vertices 4.6.10.
    TruncatedIcosidodecahedron,
    /// Vertices 3.3.3.3.5; chiral.
    SnubDodecahedron,
}

impl Platonic {
    /// All five, by number of faces.
    pub const ALL: [Self; 5] =
        [Self::Tetrahedron, Self::Cube, Self::Octahedron, Self::Dodecahedron, Self::Icosahedron];

    pub(super) fn raw(self) -> Raw {
        let mut orbits = Orbits::default();
        match self {
            Self::Tetrahedron => orbits.add(&EVEN, Minus::Even, [1.0, 1.0, 1.0]),
            Self::Cube => orbits.add(&EVEN, Minus::Any, [1.0, 1.0, 1.0]),
            Self::Octahedron => orbits.add(&EVEN, Minus::Any, [1.0, 0.0, 0.0]),
            Self::Dodecahedron => {
                orbits.add(&EVEN, Minus::Any, [1.0, 1.0, 1.0]);
                orbits.add(&EVEN, Minus::Any, [0.0, PHI - 1.0, PHI]);
            }
            Self::Icosahedron => orbits.add(&EVEN, Minus::Any, [0.0, 1.0, PHI]),
        }
        orbits.raw()
    }
}

impl Archimedean {
    /// All thirteen, by symmetry and number of vertices.
    pub const ALL: [Self; 13] = [
        Self::TruncatedTetrahedron,
        Self::Cuboctahedron,
        Self::TruncatedCube,
        Self::TruncatedOctahedron,
        Self::Rhombicuboctahedron,
        Self::TruncatedCuboctahedron,
        Self::SnubCube,
        Self::Icosidodecahedron,
        Self::TruncatedDodecahedron,
        Self::TruncatedIcosahedron,
        Self::Rhombicosidodecahedron,
        Self::TruncatedIcosidodecahedron,
        Self::SnubDodecahedron,
    ];

    pub(super) fn raw(self) -> Raw {
        let root = std::f64::consts::SQRT_2;
        let mut orbits = Orbits::default();
        match self {
            Self::TruncatedTetrahedron => orbits.add(&EVEN, Minus::Even, [1.0, 1.0, 3.0]),
            Self::Cuboctahedron => orbits.add(&EVEN, Minus::Any, [1.0, 1.0, 0.0]),
            Self::TruncatedCube => orbits.add(&EVEN, Minus::Any, [root - 1.0, 1.0, 1.0]),
            Self::TruncatedOctahedron => orbits.add(&ALL, Minus::Any, [0.0, 1.0, 2.0]),
            Self::Rhombicuboctahedron => orbits.add(&EVEN, Minus::Any, [1.0, 1.0, 1.0 + root]),
            Self::TruncatedCuboctahedron => {
                orbits.add(&ALL, Minus::Any, [1.0, 1.0 + root, 1.0 + 2.0 * root])
            }
            Self::SnubCube => {
                orbits.add(&EVEN, Minus::Odd, [1.0, 1.0 / TRIBONACCI, TRIBONACCI]);
                orbits.add(&ODD, Minus::Even, [1.0, 1.0 / TRIBONACCI, TRIBONACCI]);
            }
            _ => self
                .icosahedral_seeds()
                .into_iter()
                .for_each(|seed| orbits.add(&EVEN, Minus::Any, seed)),
        }
        if self == Self::SnubDodecahedron {
            snub_dodecahedron_seeds()
                .into_iter()
                .for_each(|seed| orbits.add(&EVEN, Minus::Even, seed));
        }
        orbits.raw()
    }

    /// Seeds of the solids with the full symmetry of the icosahedron, edge lengths 1, 2/φ or 2.
    fn icosahedral_seeds(self) -> Vec<[f64; 3]> {
        let squared = PHI + 1.0;
        match self {
            Self::Icosidodecahedron => vec![[0.0, 0.0, PHI], [0.5, PHI / 2.0, squared / 2.0]],
            Self::TruncatedDodecahedron => {
                vec![[0.0, PHI - 1.0, 2.0 + PHI], [PHI - 1.0, PHI, 2.0 * PHI], [PHI, 2.0, squared]]
            }
            Self::TruncatedIcosahedron => {
                vec![
                    [0.0, 1.0, 3.0 * PHI],
                    [1.0, 2.0 + PHI, 2.0 * PHI],
                    [PHI, 2.0, 2.0 * PHI + 1.0],
                ]
            }
            Self::Rhombicosidodecahedron => {
                vec![
                    [1.0, 1.0, 2.0 * PHI + 1.0],
                    [squared, PHI, 2.0 * PHI],
                    [2.0 + PHI, 0.0, squared],
                ]
            }
            Self::TruncatedIcosidodecahedron => vec![
                [PHI - 1.0, PHI - 1.0, 3.0 + PHI],
                [2.0 * (PHI - 1.0), PHI, 1.0 + 2.0 * PHI],
                [PHI - 1.0, squared, 3.0 * PHI - 1.0],
                [2.0 * PHI - 1.0, 2.0, 2.0 + PHI],
                [PHI, 3.0, 2.0 * PHI],
            ],
            _ => Vec::new(),
        }
    }
}

/// The five seeds of the snub dodecahedron, from the root ξ.
fn snub_dodecahedron_seeds() -> [[f64; 3]; 5] {
    let inverse = PHI - 1.0;
    let a = XI - 1.0 / XI;
    let b = XI * PHI + (PHI + 1.0) + PHI / XI;
    [
        [2.0 * a, 2.0, 2.0 * b],
        [a + b * inverse + PHI, -a * PHI + b + inverse, a * inverse + b * PHI - 1.0],
        [a + b * inverse - PHI, a * PHI - b + inverse, a * inverse + b * PHI + 1.0],
        [-a * inverse + b * PHI + 1.0, -a + b * inverse - PHI, a * PHI + b - inverse],
        [-a * inverse + b * PHI - 1.0, a - b * inverse - PHI, a * PHI + b + inverse],
    ]
}

/// Which coordinate of the seed goes where.
type Order = [usize; 3];

/// Even permutations.
const EVEN: [Order; 3] = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
/// Odd permutations.
const ODD: [Order; 3] = [[0, 2, 1], [2, 1, 0], [1, 0, 2]];
/// All permutations.
const ALL: [Order; 6] = [EVEN[0], EVEN[1], EVEN[2], ODD[0], ODD[1], ODD[2]];

/// How many of the three coordinates may change their sign.
#[derive(Clone, Copy, PartialEq)]
enum Minus {
    Any,
    Even,
    Odd,
}

/// The points collected so far: by seed, permutation and signs, each once.
#[derive(Default)]
struct Orbits(Vec<DVec3>);

impl Orbits {
    fn add(&mut self, orders: &[Order], minus: Minus, seed: [f64; 3]) {
        for order in orders {
            let point = DVec3::from_array(order.map(|i| seed[i]));
            for signs in 0_u32..8 {
                let fits = match minus {
                    Minus::Any => true,
                    Minus::Even => signs.count_ones() % 2 == 0,
                    Minus::Odd => signs.count_ones() % 2 == 1,
                };
                // Adding zero turns a −0 into 0.
                let sign = |axis: u32| if signs >> axis & 1 == 1 { -1.0 } else { 1.0 };
                let image = point * DVec3::new(sign(0), sign(1), sign(2)) + DVec3::ZERO;
                if fits && !self.0.contains(&image) {
                    self.0.push(image);
                }
            }
        }
    }

    fn raw(self) -> Raw {
        let faces = faces(&self.0);
        Raw { points: self.0, faces }
    }
}

/// The faces of a convex solid with equal edges whose vertices lie on a sphere about the origin.
///
/// Each face begins at its lowest vertex; the faces are in lexicographic order.
fn faces(points: &[DVec3]) -> Vec<Vec<usize>> {
    let around = neighbours_in_turn(points);
    let place =
        |v: usize, u: usize| around[v].iter().position(|&w| w == u).expect("neighbours are mutual");
    let mut done: Vec<Vec<bool>> = around.iter().map(|ring| vec![false; ring.len()]).collect();
    let mut faces = Vec::new();
    for start in 0..points.len() {
        let mut ring = around[start].clone();
        ring.sort_unstable();
        for first in ring {
            let mut face = Vec::new();
            let (mut from, mut to) = (start, first);
            while !std::mem::replace(&mut done[from][place(from, to)], true) {
                face.push(from);
                // The face lies on the left: at `to`, the edge before the one we came by,
                // counter-clockwise.
                let ring = &around[to];
                (from, to) = (to, ring[(place(to, from) + ring.len() - 1) % ring.len()]);
            }
            if !face.is_empty() {
                faces.push(face);
            }
        }
    }
    faces
}

/// For each point its nearest points, counter-clockwise seen from outside.
fn neighbours_in_turn(points: &[DVec3]) -> Vec<Vec<usize>> {
    let least =
        points[1..].iter().map(|p| p.distance_squared(points[0])).fold(f64::INFINITY, f64::min);
    let ring = |centre: DVec3| {
        // The next larger distance, a diagonal of a square, is at least 1.4 edges: any factor
        // between would do.
        let is_near = |p: DVec3| p != centre && p.distance_squared(centre) < 1.2 * least;
        let mut ring: Vec<usize> = (0..points.len()).filter(|&i| is_near(points[i])).collect();
        // Two directions that span the tangent plane; the third of a right-handed frame is the way
        // out.
        let y = centre.cross(points[ring[0]] - centre).normalize();
        let x = y.cross(centre).normalize();
        let angle = |i: usize| (points[i] - centre).dot(y).atan2((points[i] - centre).dot(x));
        ring.sort_by(|&i, &j| angle(i).total_cmp(&angle(j)));
        ring
    };
    points.iter().map(|&p| ring(p)).collect()
}
