//! Options of the robot: how it moves, what it sees, what goes wrong.

use clap::ValueEnum;
use clap::builder::PossibleValuesParser;
use covimap_sim::{Angle, Motion, Recognition, RunSpec, SensorSpec};

use super::{range, refuse_left, set};

/// Lengths in metres, angles in degrees.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// How the robot chooses its way [default: wander; patrol in spiral and corridor-tree]
    #[arg(long, value_name = "MOTION", value_parser = PossibleValuesParser::new(Motion::ALL.map(|m| m.name())))]
    motion: Option<String>,
    /// Sweep: distance between two lanes [default: 0.5]
    #[arg(long, value_name = "M")]
    lane: Option<f64>,
    /// Robots that go one after another, from random places [default: 1]
    #[arg(long, value_name = "N")]
    robots: Option<u32>,
    /// Largest turn of a step to either side [default: 45]
    #[arg(long, value_name = "DEG")]
    turn: Option<f64>,
    /// Length of a step, or the least and the greatest [default: 0.1,0.2; paper-room: 0.1]
    #[arg(long, value_name = "M[,M]", value_parser = range)]
    step: Option<[f64; 2]>,
    /// Distance kept from walls and solid landmarks [default: 0.05; paper-room: 0.04]
    #[arg(long, value_name = "M")]
    clearance: Option<f64>,
    /// On what recognition depends [default: range; visual-angle in paper-room]
    #[arg(long, value_enum, value_name = "KIND")]
    recognition: Option<Kind>,
    /// By range: distance of half the chance [default: 0.55]
    #[arg(long, value_name = "M")]
    range: Option<f64>,
    /// By range: softness of the edge [default: 0.04]
    #[arg(long, value_name = "M")]
    edge: Option<f64>,
    /// By range: chance to recognise a landmark close by [default: 0.95]
    #[arg(long, value_name = "P")]
    detection: Option<f64>,
    /// By visual angle: threshold, or the least and the greatest of thresholds that differ [default: 5]
    #[arg(long, value_name = "DEG[,DEG]", value_parser = range)]
    threshold: Option<[f64; 2]>,
    /// By visual angle: steepness of a logistic chance, per radian [default: sharp]
    #[arg(long, value_name = "K")]
    steepness: Option<f64>,
    /// Field of view [default: 360]
    #[arg(long, value_name = "DEG")]
    view: Option<f64>,
    /// Factor on every landmark's chance, or the least and the greatest of factors that differ [default: 1]
    #[arg(long, value_name = "P[,P]", value_parser = range)]
    detectability: Option<[f64; 2]>,
    /// Tell the range to everything seen, too; with noise of this share of it [default: no ranges]
    #[arg(long, value_name = "SHARE")]
    range_noise: Option<f64>,
    /// Share of sightings that are lost [default: 0]
    #[arg(long, value_name = "SHARE")]
    missed: Option<f64>,
    /// Share of sightings that turn into another landmark [default: 0]
    #[arg(long, value_name = "SHARE")]
    mistaken: Option<f64>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Kind {
    /// The distance
    Range,
    /// The angle under which the part shows that nothing hides; landmarks need a --diameter
    VisualAngle,
}

impl Options {
    /// Changes the run by what was given.
    ///
    /// # Errors
    /// A conflict, exit code 2, for an option that the motion or the kind of recognition does not have;
    /// [`covimap_sim::SimError`] for an unknown motion.
    pub fn apply(mut self, spec: &mut RunSpec) -> anyhow::Result<()> {
        if let Some(name) = self.motion.take() {
            spec.motion = name.parse()?;
        }
        if let Motion::Sweep { lane } = &mut spec.motion {
            set(lane, &mut self.lane);
        }
        refuse_left([("--lane", self.lane.is_some())], &format!("--motion {}", spec.motion.name()))?;
        set(&mut spec.robots, &mut self.robots);
        set(&mut spec.step.turn, &mut self.turn.map(Angle::from_deg));
        if let Some([shortest, longest]) = self.step {
            (spec.step.shortest, spec.step.longest) = (shortest, longest);
        }
        set(&mut spec.step.clearance, &mut self.clearance);
        set(&mut spec.errors.missed, &mut self.missed);
        set(&mut spec.errors.mistaken, &mut self.mistaken);
        self.apply_sensor(&mut spec.sensor)
    }

    fn apply_sensor(mut self, spec: &mut SensorSpec) -> anyhow::Result<()> {
        set(&mut spec.view, &mut self.view.map(Angle::from_deg));
        set(&mut spec.detectability, &mut self.detectability);
        set(&mut spec.range_noise, &mut self.range_noise.map(Some));
        match (self.recognition, spec.recognition) {
            (Some(Kind::Range), Recognition::VisualAngle { .. }) => {
                spec.recognition = SensorSpec::default().recognition;
            }
            (Some(Kind::VisualAngle), Recognition::Range { .. }) => spec.recognition = Recognition::paper(),
            _ => {}
        }
        let kind = match &mut spec.recognition {
            Recognition::Range { range, edge, detection } => {
                set(range, &mut self.range);
                set(edge, &mut self.edge);
                set(detection, &mut self.detection);
                "recognition by range"
            }
            Recognition::VisualAngle { threshold, steepness } => {
                set(threshold, &mut self.threshold.take().map(|range| range.map(Angle::from_deg)));
                set(steepness, &mut self.steepness.take().map(Some));
                "recognition by visual angle"
            }
        };
        let left = [
            ("--range", self.range.is_some()),
            ("--edge", self.edge.is_some()),
            ("--detection", self.detection.is_some()),
            ("--threshold", self.threshold.is_some()),
            ("--steepness", self.steepness.is_some()),
        ];
        refuse_left(left, kind)
    }
}
