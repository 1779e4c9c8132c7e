//! Hand-made nets for the tests of this module.

use glam::DVec2;

use crate::net::{
    EdgeLabel, FlatFace, Fold, FoldKind, MeshCounts, Net, Piece, PieceId, Proof, Seam, SeamSide,
};

pub(crate) fn points<const N: usize>(corners: [(f64, f64); N]) -> Vec<DVec2> {
    corners.map(DVec2::from).to_vec()
}

pub(crate) fn square(side: f64) -> Vec<DVec2> {
    points([(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)])
}

pub(crate) fn ell() -> Vec<DVec2> {
    points([(0.0, 0.0), (40.0, 0.0), (40.0, 20.0), (20.0, 20.0), (20.0, 40.0), (0.0, 40.0)])
}

/// A convex polygon of 5 to 8 corners, 20 to 70 mm across, turned anyhow.
pub(crate) fn random_convex(seed: u64) -> Vec<DVec2> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1);
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (corners, radius, stretch, turn) =
        (5 + (next() * 4.0) as usize, 10.0 + 25.0 * next(), 0.4 + 0.6 * next(), next());
    let angle =
        |i: usize, shake: f64| (i as f64 + 0.4 * shake) / corners as f64 * std::f64::consts::TAU;
    let circle: Vec<DVec2> =
        (0..corners).map(|i| DVec2::from_angle(angle(i, next())) * radius).collect();
    let across = DVec2::from_angle(turn * 7.0);
    circle.into_iter().map(|p| across.rotate(p * DVec2::new(1.0, stretch))).collect()
}

/// A piece of one face.
pub(crate) fn piece(id: PieceId, outline: Vec<DVec2>) -> Piece {
    let face =
        FlatFace { face: id.0, vertices: (0..outline.len()).collect(), polygon: outline.clone() };
    Piece { id, outline, holes: vec![], faces: vec![face] }
}

/// A square of 30 mm with a square hole of 10 mm, of four faces.
pub(crate) fn ring(id: PieceId) -> Piece {
    let outer = square(30.0);
    let inner = points([(10.0, 10.0), (20.0, 10.0), (20.0, 20.0), (10.0, 20.0)]);
    let face = |i: usize| {
        let j = (i + 1) % 4;
        let polygon = vec![outer[i], outer[j], inner[j], inner[i]];
        FlatFace { face: 100 + i, vertices: vec![i, j, 4 + j, 4 + i], polygon }
    };
    let faces = (0..4).map(face).collect();
    Piece { id, outline: outer.clone(), holes: vec![inner.iter().rev().copied().collect()], faces }
}

/// One piece of `count` upright strips side by side, folded between any two; the outer two are 30
/// mm wide.
pub(crate) fn strips(count: usize, width: f64, height: f64) -> Net {
    let mut net = net_of(vec![]);
    let x = |i: usize| match i {
        0 => 0.0,
        i if i == count => 60.0 + width * (count - 2) as f64,
        i => 30.0 + width * (i - 1) as f64,
    };
    let face = |i: usize| {
        let polygon = points([(x(i), 0.0), (x(i + 1), 0.0), (x(i + 1), height), (x(i), height)]);
        FlatFace { face: i, vertices: vec![2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1], polygon }
    };
    let bottom = (0..=count).map(|i| DVec2::new(x(i), 0.0));
    let top = (0..=count).rev().map(|i| DVec2::new(x(i), height));
    let outline = bottom.chain(top).collect();
    net.folds = (1..count)
        .map(|i| Fold {
            id: EdgeLabel(i),
            edge: [2 * i, 2 * i + 1],
            piece: PieceId(0),
            faces: [i - 1, i],
            segment: [DVec2::new(x(i), 0.0), DVec2::new(x(i), height)],
            fold_angle: 10.0,
            kind: FoldKind::Mountain,
        })
        .collect();
    net.pieces = vec![Piece {
        id: PieceId(0),
        outline,
        holes: vec![],
        faces: (0..count).map(face).collect(),
    }];
    net
}

/// Pieces of one face each, without seams.
pub(crate) fn net_of(contours: Vec<Vec<DVec2>>) -> Net {
    let pieces = contours.into_iter().enumerate().map(|(i, c)| piece(PieceId(i), c)).collect();
    let counts = MeshCounts { vertices: 0, edges: 0, faces: 0 };
    Net {
        scale: 1.0,
        counts,
        pieces,
        folds: vec![],
        seams: vec![],
        rims: vec![],
        proof: Proof::default(),
    }
}

/// Two pieces: a strip of two squares with a mountain fold, and one square, joined by one seam; a
/// triangle by another.
pub(crate) fn two_pieces() -> Net {
    let strip =
        points([(0.0, 0.0), (30.0, 0.0), (60.0, 0.0), (60.0, 30.0), (30.0, 30.0), (0.0, 30.0)]);
    let left = FlatFace {
        face: 0,
        vertices: vec![0, 1, 4, 5],
        polygon: vec![strip[0], strip[1], strip[4], strip[5]],
    };
    let right = FlatFace {
        face: 1,
        vertices: vec![1, 2, 3, 4],
        polygon: vec![strip[1], strip[2], strip[3], strip[4]],
    };
    let first =
        Piece { id: PieceId(0), outline: strip.clone(), holes: vec![], faces: vec![left, right] };
    let mut second = piece(PieceId(1), square(30.0));
    second.faces[0].face = 2;
    second.faces[0].vertices = vec![3, 2, 6, 7];
    let fold = Fold {
        id: EdgeLabel(4),
        edge: [1, 4],
        piece: PieceId(0),
        faces: [0, 1],
        segment: [strip[1], strip[4]],
        fold_angle: 30.0,
        kind: FoldKind::Mountain,
    };
    let side = |piece, face, a, b| SeamSide { piece: PieceId(piece), face, segment: [a, b] };
    let seam = Seam {
        id: EdgeLabel(16),
        edge: [2, 3],
        length: 30.0,
        fold_angle: 90.0,
        sides: [side(0, 1, strip[2], strip[3]), side(1, 2, DVec2::new(30.0, 0.0), DVec2::ZERO)],
    };
    let mut net = net_of(vec![]);
    (net.pieces, net.folds, net.seams) = (vec![first, second], vec![fold], vec![seam]);
    net
}

/// A polygon and its copy, joined along all edges: what two faces of a thin body would be.
pub(crate) fn twins(contour: Vec<DVec2>, fold_angle: f64) -> Net {
    let mut net = two_pieces();
    let n = contour.len();
    let low = contour.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let front: Vec<DVec2> = contour.iter().map(|&p| p - low).collect();
    let back: Vec<DVec2> = (0..n).map(|i| front[(n - i) % n] * DVec2::new(-1.0, 1.0)).collect();
    let mut piece = |i: usize, polygon: &[DVec2], vertices: Vec<usize>| {
        let p = &mut net.pieces[i];
        (p.outline, p.holes) = (polygon.to_vec(), vec![]);
        p.faces.truncate(1);
        (p.faces[0].face, p.faces[0].polygon, p.faces[0].vertices) =
            (i, polygon.to_vec(), vertices);
    };
    piece(0, &front, (0..n).collect());
    piece(1, &back, (0..n).map(|i| (n - i) % n).collect());
    net.folds.clear();
    let side =
        |piece: usize, a, b| SeamSide { piece: PieceId(piece), face: piece, segment: [a, b] };
    net.seams = (0..n)
        .map(|i| {
            let j = (i + 1) % n;
            let sides =
                [side(0, front[i], front[j]), side(1, back[(n - i) % n], back[(n - j) % n])];
            let length = front[i].distance(front[j]);
            Seam { id: EdgeLabel(i), edge: [i, j], length, fold_angle, sides }
        })
        .collect();
    net
}
