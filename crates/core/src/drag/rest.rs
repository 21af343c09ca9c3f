//! What moves with the belt besides the lubricated contact.

/// What moves with the belt besides the lubricated contact: a drag of its own, `force + damping v`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rest {
    /// Drag at any speed.
    pub force: f64,
    /// Drag per speed.
    pub damping: f64,
}

impl Rest {
    /// Drag at `u >= 0`.
    pub(crate) fn at(&self, u: f64) -> f64 {
        self.force + self.damping * u
    }

    /// Whether there is any.
    pub(crate) fn is_none(&self) -> bool {
        self.force == 0.0 && self.damping == 0.0
    }

    /// The same, `factor` times as large.
    pub(crate) fn scaled(self, factor: f64) -> Self {
        Self { force: self.force * factor, damping: self.damping * factor }
    }
}
