//! The samples of an experiment, and the means that figures and tables are made of.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::experiment::{Experiment, MapMethod, Measure};
use super::runner::Sample;
use super::statistics::Mean;

/// What an experiment gave.
#[derive(Debug)]
pub struct Results {
    pub experiment: Experiment,
    pub samples: Vec<Sample>,
}

/// One point of a curve.
#[derive(Debug, Clone, Copy)]
pub struct CurvePoint {
    pub steps: usize,
    /// Mean co-visibility information.
    pub information: f64,
    /// Mean number of landmarks compared.
    pub landmarks: f64,
    /// Mean errors, in the order of [`Measure::BOTH`].
    pub errors: [Mean; 2],
}

impl Results {
    /// Place of a method among those of the experiment.
    pub fn method(&self, method: MapMethod) -> Option<usize> {
        self.experiment.methods.iter().position(|&known| known == method)
    }

    /// Place of the setting with this label.
    pub fn setting(&self, label: &str) -> Option<usize> {
        self.experiment.settings.iter().position(|setting| setting.label == label)
    }

    /// The error in every run of a setting after so many steps, by run.
    pub fn errors(
        &self,
        setting: usize,
        method: usize,
        steps: usize,
        measure: Measure,
    ) -> BTreeMap<(u64, u64), f64> {
        self.at(steps)
            .filter(|sample| sample.setting == setting)
            .map(|sample| (sample.run, sample.maps[method].of(measure)))
            .collect()
    }

    /// The mean error of a setting after so many steps.
    pub fn mean(&self, setting: usize, method: usize, steps: usize, measure: Measure) -> Mean {
        Mean::of(&self.errors(setting, method, steps, measure).into_values().collect::<Vec<_>>())
    }

    /// The mean of the error of one setting and method less that of another, run by run over the same worlds.
    pub fn difference(
        &self,
        (of, of_method): (usize, usize),
        (minus, minus_method): (usize, usize),
        steps: usize,
        measure: Measure,
    ) -> Mean {
        let minus = self.errors(minus, minus_method, steps, measure);
        let of = self.errors(of, of_method, steps, measure);
        let pairs = of.iter().filter_map(|(run, error)| Some(error - minus.get(run)?));
        Mean::of(&pairs.collect::<Vec<_>>())
    }

    /// The mean error over all settings, and the mean of what `of` makes of a sample in general: settings of
    /// one run are averaged first, since they share the world and are not independent.
    pub fn pooled(&self, steps: usize, of: impl Fn(&Sample) -> f64) -> Mean {
        let mut runs = BTreeMap::<(u64, u64), Vec<f64>>::new();
        for sample in self.at(steps) {
            runs.entry(sample.run).or_default().push(of(sample));
        }
        Mean::of(&runs.values().map(|values| Mean::of(values).mean).collect::<Vec<_>>())
    }

    /// How a setting's errors go on with the steps.
    pub fn curve(&self, setting: usize, method: usize) -> Vec<CurvePoint> {
        let point = |&steps: &usize| {
            let samples = || self.at(steps).filter(|sample| sample.setting == setting);
            let mean = |of: &dyn Fn(&Sample) -> f64| Mean::of(&samples().map(of).collect::<Vec<_>>());
            CurvePoint {
                steps,
                information: mean(&|sample| sample.information).mean,
                landmarks: mean(&|sample| sample.maps[method].landmarks as f64).mean,
                errors: Measure::BOTH.map(|measure| mean(&|sample| sample.maps[method].of(measure))),
            }
        };
        let points = self.experiment.steps.iter().map(point);
        points.filter(|point| point.errors[0].n > 0).collect()
    }

    /// Writes all curves: a row for each setting, method and number of steps.
    ///
    /// # Errors
    /// What the output says.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(
            out,
            "experiment,setting,method,steps,runs,landmarks,information,delaunay_error,delaunay_se,\
             orientation_error,orientation_se"
        )?;
        for (s, setting) in self.experiment.settings.iter().enumerate() {
            for (m, method) in self.experiment.methods.iter().enumerate() {
                for CurvePoint { steps, information, landmarks, errors: [del, ori] } in self.curve(s, m) {
                    writeln!(
                        out,
                        "{},{},{},{steps},{},{landmarks:.2},{information:.1},{:.5},{},{:.5},{}",
                        self.experiment.name,
                        setting.label,
                        method.label(),
                        del.n,
                        del.mean,
                        del.error_text(),
                        ori.mean,
                        ori.error_text(),
                    )?;
                }
            }
        }
        Ok(())
    }

    /// Writes a row for each run and method: what the exploration was like, and the errors.
    ///
    /// # Errors
    /// What the output says.
    pub fn write_runs_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(
            out,
            "experiment,layout,walk,steps,method,landmarks,spread,entropy,delaunay_error,orientation_error"
        )?;
        for sample in &self.samples {
            for (method, map) in self.experiment.methods.iter().zip(&sample.maps) {
                let (layout, walk) = sample.run;
                writeln!(
                    out,
                    "{},{layout},{walk},{},{},{},{:.5},{:.5},{:.5},{:.5}",
                    self.experiment.name,
                    sample.steps,
                    method.label(),
                    map.landmarks,
                    sample.spread,
                    sample.entropy,
                    map.delaunay,
                    map.orientation,
                )?;
            }
        }
        Ok(())
    }

    fn at(&self, steps: usize) -> impl Iterator<Item = &Sample> {
        self.samples.iter().filter(move |sample| sample.steps == steps)
    }
}
