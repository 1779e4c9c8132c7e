//! What one face adds to the system: a dense matrix over its corners and its plane.

use glam::{DMat3, DVec3};

/// The second derivative and the slope of a face's terms. The unknowns are three for each corner,
/// then three of the plane: its tilts along two axes, and its way along the normal.
pub(super) struct Element {
    corners: usize,
    /// Row by row, symmetric.
    matrix: Vec<f64>,
    /// The slope; after [`Self::eliminate_plane`] that of the corners alone.
    pub slope: Vec<f64>,
    full_slope: Vec<f64>,
    /// The inverse of the plane's own block; zero when the plane is given.
    inverse: DMat3,
    /// Whether the plane is given, and no unknown.
    is_plane_fixed: bool,
    /// The row being summed up.
    row: Vec<(usize, f64)>,
}

impl Element {
    /// No terms yet, of a face with so many corners, whose plane may be given.
    pub(super) fn new(corners: usize, is_plane_fixed: bool) -> Self {
        let size = 3 * corners + 3;
        Self {
            corners,
            matrix: vec![0.0; size * size],
            slope: Vec::new(),
            full_slope: vec![0.0; size],
            inverse: DMat3::ZERO,
            is_plane_fixed,
            row: Vec::with_capacity(size),
        }
    }

    fn size(&self) -> usize {
        3 * self.corners + 3
    }

    /// Begins a residual: its derivatives follow.
    pub(super) fn by(&mut self, corner: usize, slope: DVec3) -> &mut Self {
        self.row.extend((0..3).map(|a| (3 * corner + a, slope[a])));
        self
    }

    /// The derivative of the residual by an unknown of the plane.
    pub(super) fn by_plane(&mut self, unknown: usize, slope: f64) -> &mut Self {
        self.row.push((3 * self.corners + unknown, slope));
        self
    }

    /// Ends a residual: adds its square, times the weight squared.
    pub(super) fn residual(&mut self, value: f64, weight: f64) {
        let size = self.size();
        let row = std::mem::take(&mut self.row);
        let square = weight * weight;
        for &(i, a) in &row {
            self.full_slope[i] += square * a * value;
            let line = &mut self.matrix[i * size..(i + 1) * size];
            for &(j, b) in &row {
                line[j] += square * a * b;
            }
        }
        self.row = row;
        self.row.clear();
    }

    /// Takes the plane out of the system (Schur 1917) with a shift on its diagonal; the residuals
    /// must not change any more. `None` when the plane is not settled.
    pub(super) fn eliminate_plane(&mut self, shift: f64) -> Option<()> {
        let (n, size) = (3 * self.corners, self.size());
        let entry = |a: usize, b: usize| self.matrix[(n + a) * size + n + b];
        let own = DMat3::from_cols_array_2d(&[0, 1, 2].map(|b| [0, 1, 2].map(|a| entry(a, b))))
            + DMat3::from_diagonal(DVec3::splat(shift));
        // A plane that does not move adds nothing to how corners are coupled.
        self.inverse = if self.is_plane_fixed { DMat3::ZERO } else { own.inverse() };
        if !self.inverse.is_finite() {
            return None;
        }
        let share = self.inverse * DVec3::from_slice(&self.full_slope[n..]);
        self.slope = (0..n).map(|i| self.full_slope[i] - self.coupling(i).dot(share)).collect();
        Some(())
    }

    /// How the plane is coupled with an unknown of the corners.
    fn coupling(&self, i: usize) -> DVec3 {
        let n = 3 * self.corners;
        DVec3::from_slice(&self.matrix[i * self.size() + n..][..3])
    }

    /// An entry of the matrix without the plane.
    pub(super) fn reduced(&self, i: usize, j: usize) -> f64 {
        let own = self.matrix[i * self.size() + j];
        own - self.coupling(i).dot(self.inverse * self.coupling(j))
    }

    /// The step of the plane that goes with steps of the corners.
    pub(super) fn plane_step(&self, steps: &[DVec3]) -> DVec3 {
        let mut slope = DVec3::from_slice(&self.full_slope[3 * self.corners..]);
        for (i, step) in steps.iter().enumerate() {
            (0..3).for_each(|a| slope += self.coupling(3 * i + a) * step[a]);
        }
        -(self.inverse * slope)
    }
}
