//! The sensor that all landmarks share.

/// Bounds of the probability `e` of a sighting that should not be. It starts at the lower one: walls
/// and soft edges let even a faultless log look a little false.
pub(super) const FALSE_SIGHTING: (f64, f64) = (1e-3, 0.2);
/// Bounds of a detectability.
pub(super) const DETECTABILITY: (f64, f64) = (0.02, 0.995);

/// What the log says of the sensor, in map units.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Sensor {
    /// Range `R` within which a landmark is seen.
    pub range: f64,
    /// Width `s` of the range's soft edge.
    pub edge: f64,
    /// Detectability of a landmark of which nothing else is known.
    pub detectability: f64,
    /// Probability `e` that a step shows a landmark nearby which cannot be seen from there.
    pub false_sighting: f64,
}

impl Sensor {
    /// The visibility curve `v(d) = 1 / (1 + exp((d - R) / s))`.
    pub(super) fn visibility(self, distance: f64) -> f64 {
        1.0 / (1.0 + ((distance - self.range) / self.edge).exp())
    }
}
