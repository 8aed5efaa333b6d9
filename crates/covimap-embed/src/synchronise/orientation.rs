//! Turns and reflections, and what edges say of them.

use nalgebra::Complex;

/// A rotation of the plane, or a rotation after mirroring the y axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Orientation {
    /// Unit complex number.
    pub(super) rotation: Complex<f64>,
    pub(super) mirrored: bool,
}

impl Orientation {
    pub(super) const IDENTITY: Self = Self { rotation: Complex::ONE, mirrored: false };

    /// First `first`, then `self`.
    pub(super) fn after(self, first: Self) -> Self {
        let turn = if self.mirrored { first.rotation.conj() } else { first.rotation };
        Self { rotation: self.rotation * turn, mirrored: self.mirrored != first.mirrored }
    }

    pub(super) fn inverse(self) -> Self {
        if self.mirrored { self } else { Self { rotation: self.rotation.conj(), ..self } }
    }
}

/// `a_from_b` with a weight `> 0`.
#[derive(Clone, Copy)]
pub(super) struct Vote {
    pub(super) a: u32,
    pub(super) b: u32,
    pub(super) a_from_b: Orientation,
    pub(super) weight: f64,
}

impl Vote {
    /// What separates the orientations of the two nodes from the vote: the identity if they agree.
    pub(super) fn left_over(&self, nodes: &[Orientation]) -> Orientation {
        nodes[self.a as usize].after(self.a_from_b).after(nodes[self.b as usize].inverse())
    }
}

/// For the tests of those who orient things.
#[cfg(test)]
pub(super) mod fixtures {
    use super::*;

    pub fn turned(angle: f64, mirrored: bool) -> Orientation {
        Orientation { rotation: Complex::from_polar(1.0, angle), mirrored }
    }

    pub fn close(a: Orientation, b: Orientation) -> bool {
        a.mirrored == b.mirrored && (a.rotation - b.rotation).norm() < 1e-12
    }
}
