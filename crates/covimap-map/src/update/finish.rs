//! From the draft to the map of the joined log.

use std::cmp::Reverse;

use covimap_embed::Point;
use rayon::prelude::*;

use super::Joined;
use super::draft::Draft;
use crate::component::ComponentMap;
use crate::mapper::Known;
use crate::places::SeenSets;
use crate::report::{carried_warning, joined_seams};
use crate::sensing::{LearntSensor, learn_one, occlusion, work};
use crate::state::{Ground, Rules, Settled};
use crate::{GlobalMap, LandmarkId, MapError, Observer, Sensed, Sensing, SensorModel, Stage, aliases};

/// Rows of one parallel task.
const ROWS: usize = 1024;

impl Draft<'_> {
    /// Maps the components without a base, and puts everything together.
    pub fn finish(mut self, observer: &dyn Observer) -> Result<(GlobalMap, Ground), MapError> {
        let joined = self.joined;
        let fresh: Vec<usize> = (0..self.base.len()).filter(|&number| self.base[number].is_none()).collect();
        let members: Vec<Vec<u32>> = fresh.iter().map(|&number| joined.components[number].clone()).collect();
        let sets = SeenSets::by_component(&joined.log, &members);
        let known = Known {
            log: &joined.log,
            counts: &joined.counts,
            graph: &joined.graph,
            components: &members,
            sets: &sets,
        };
        let mapper = joined.mapper();
        let mut fresh_maps = mapper.auto_components(&known, None, observer)?.into_iter();
        let mut fresh_sets = sets.iter();

        let work = members.iter().zip(&sets).map(|(members, sets)| work(members, sets)).sum();
        observer.started(Stage::Sensor, Some(work));
        let (mut maps, mut rules, mut sensors) = (Vec::new(), Vec::new(), Vec::new());
        let branches = self.regions.branches();
        for (number, members) in joined.components.iter().enumerate() {
            if let Some(base) = self.base[number] {
                maps.push(self.component_map(number, base, &branches));
                rules.push(joined.old.ground.rules[base as usize].clone());
                let sensing =
                    joined.old_map().sensing().expect("a chart of three has a sensor (bug in covimap)");
                sensors.push(*sensing.sensor(base));
                self.fill_in(members, sensors[number]);
            } else {
                let mut map = fresh_maps.next().expect("one map a component (bug in covimap)");
                let sets = fresh_sets.next().expect("one list of sets a component (bug in covimap)");
                let basis = std::mem::take(&mut map.basis);
                for (place, &member) in members.iter().enumerate() {
                    self.polished[member as usize] = basis.polished[place];
                    self.free[member as usize] = true;
                }
                rules.push(Rules { law: basis.law, sensor: basis.sensor });
                sensors.extend(self.learn(members, &map.points, sets, &sensors, observer)?);
                maps.push(map);
            }
        }
        let sensing = self.sensing(sensors, &maps)?;
        observer.finished(Stage::Sensor);
        let known = Known { components: &joined.components, sets: &[], ..known };
        let mut map = mapper.assemble(&known, joined.honesty, maps, sensing)?;
        self.warn(&mut map);
        Ok((map, self.into_ground(rules)))
    }

    /// A component that keeps an old frame.
    fn component_map(&self, number: usize, base: u32, branches: &[u32]) -> ComponentMap {
        let joined = self.joined;
        let members = &joined.components[number];
        let own = |&member: &u32| self.regions.of[member as usize];
        let mut regions: Vec<u32> = members.iter().map(own).collect();
        regions.sort_unstable();
        regions.dedup();
        let place = |region: u32| regions.binary_search(&region).ok().map(|place| place as u32);
        let region: Vec<u32> =
            members.iter().map(|member| place(own(member)).expect("it is in (bug in covimap)")).collect();
        let branch_of = by_size(&regions, &region, branches);
        let mut charts = vec![base];
        charts.extend(
            self.carried.iter().filter(|carried| carried.0 as usize == number).map(|carried| carried.1),
        );
        let old = &joined.old_map().report().components;
        let report = &old[base as usize];
        let seams = charts.iter().map(|&chart| &old[chart as usize].seams);
        let moved = members.iter().any(|&member| self.free[member as usize]) || charts.len() > 1;
        ComponentMap {
            points: members.iter().map(|&member| self.points[member as usize]).collect(),
            regions: regions.len(),
            seams: joined_seams(seams, &self.regions.hinges, place),
            branch_of,
            region,
            path_pull: report.path_pull,
            network: report.network,
            stress1: if moved { self.stress1(members) } else { report.stress1 },
            iterations: report.iterations as usize,
            converged: report.converged,
            distances: report.distances.clone(),
            ranges: None,
            basis: Default::default(),
        }
    }

    /// Kruskal's stress-1 of a component over all its links, summed in a fixed order.
    fn stress1(&self, members: &[u32]) -> f64 {
        let row = |&landmark: &u32| {
            let mut sums = [0.0; 2];
            for (link, count) in self.joined.counted_links(landmark).filter(|(link, _)| link.to > landmark) {
                let (distance, weight) = self.measure(landmark, link, count);
                let [a, b]: [Point; 2] = [landmark, link.to].map(|end| self.points[end as usize]);
                let length = (a[0] - b[0]).hypot(a[1] - b[1]);
                sums[0] += weight * (length - distance).powi(2);
                sums[1] += weight * length * length;
            }
            sums
        };
        let chunk = |members: &[u32]| {
            members.iter().map(row).fold([0.0; 2], |a: [f64; 2], b| [a[0] + b[0], a[1] + b[1]])
        };
        let sums: Vec<[f64; 2]> = members.par_chunks(ROWS).map(chunk).collect();
        let [residual, lengths] = [0, 1].map(|k| sums.iter().map(|sums| sums[k]).sum::<f64>());
        if lengths > 0.0 { (residual / lengths).sqrt() } else { 0.0 }
    }

    /// The sensor of a component that was mapped anew; `None` if it is too small and there is no other.
    fn learn(
        &mut self,
        members: &[u32],
        points: &[Point],
        sets: &SeenSets,
        sensors: &[SensorModel],
        observer: &dyn Observer,
    ) -> Result<Option<SensorModel>, MapError> {
        if members.len() < 3 {
            let Some(&sensor) = sensors.first() else { return Ok(None) };
            for &member in members {
                self.sensed[member as usize] = Some(sensor.unseen());
            }
            return Ok(Some(sensor));
        }
        let joined = self.joined;
        let graph = joined.graph.restricted_to(members);
        let LearntSensor { sensor, sensed } =
            learn_one(&joined.counts, &graph, members, points, sets, observer)?;
        for (place, &member) in members.iter().enumerate() {
            self.sensed[member as usize] = Some(sensed[place]);
            self.points[member as usize] = points[place];
        }
        Ok(Some(sensor))
    }

    /// Landmarks of which nothing was learnt, for want of a refinement, are like any other; and where new landmarks stand,
    /// the chart is bent as it is at those linked to them, or else as it is on the whole.
    fn fill_in(&mut self, members: &[u32], sensor: SensorModel) {
        let Some(old) = self.joined.old_map().sensing() else { return };
        let is_old = |landmark: &u32| (*landmark as usize) < old.landmarks();
        let warp = |among: &mut dyn Iterator<Item = u32>| {
            let (squares, count) = among.fold((0.0, 0.0), |(squares, count), landmark| {
                (squares + old.of(LandmarkId(landmark)).warp.powi(2), count + 1.0)
            });
            (count > 0.0).then(|| f64::sqrt(squares / count))
        };
        let on_the_whole = warp(&mut members.iter().copied().filter(is_old)).unwrap_or(0.0);
        for &member in members.iter().filter(|member| !is_old(member)) {
            let linked = self.joined.graph.of(member).iter().map(|link| link.to);
            let warp = warp(&mut linked.filter(is_old)).unwrap_or(on_the_whole);
            let known = self.sensed[member as usize].unwrap_or(sensor.unseen());
            self.sensed[member as usize] = Some(Sensed { warp, ..known });
        }
    }

    /// What the map knows of its sensor. Pairs of landmarks that kept their places are occluded if they were.
    fn sensing(&self, sensors: Vec<SensorModel>, maps: &[ComponentMap]) -> Result<Option<Sensing>, MapError> {
        if sensors.is_empty() {
            return Ok(None);
        }
        let joined = self.joined;
        let is_free = |[a, b]: [u32; 2]| self.free[a as usize] || self.free[b as usize];
        let old = joined.old_map().sensing().into_iter().flat_map(Sensing::occluded_pairs);
        let together =
            |&[a, b]: &[u32; 2]| joined.component_of[a as usize] == joined.component_of[b as usize];
        let mut occluded: Vec<[u32; 2]> = old.filter(|pair| !is_free(*pair) && together(pair)).collect();
        for ((members, map), sensor) in joined.components.iter().zip(maps).zip(&sensors) {
            if members.len() >= 3 && members.iter().any(|&member| self.free[member as usize]) {
                let chance = |&member: &u32| {
                    self.sensed[member as usize].map_or(sensor.detectability, |sensed| sensed.detectability)
                };
                let detectability: Vec<f64> = members.iter().map(chance).collect();
                let found = occlusion::pairs(&joined.counts, members, &map.points, sensor, &detectability);
                occluded.extend(found.into_iter().filter(|pair| is_free(*pair)));
            }
        }
        let sensed = self.sensed.iter().map(|sensed| sensed.expect("all is filled in (bug in covimap)"));
        Sensing::from_parts(sensors, sensed.collect(), &occluded).map(Some)
    }

    fn warn(&self, map: &mut GlobalMap) {
        let joined = self.joined;
        let aliases = aliases::find(&joined.counts);
        if !aliases.is_empty() {
            map.report.warnings.insert(0, aliases::warning(&joined.log, &aliases, false));
        }
        let first = |&(component, chart): &(u32, u32)| {
            let members = joined.charts[chart as usize].iter();
            let mut own = members.filter(|&&member| joined.component_of[member as usize] == component);
            own.next().map(|&member| joined.log.names().name(LandmarkId(member)))
        };
        map.report.warnings.extend(carried_warning(self.carried.iter().filter_map(first)));
    }

    fn into_ground(self, rules: Vec<Rules>) -> Ground {
        let Joined { old, counts, graph, .. } = self.joined;
        let settled = |landmark: u32| match old.ground.settled.get(landmark as usize) {
            Some(&settled) if !self.free[landmark as usize] => settled,
            _ => Settled {
                sightings: counts.sightings()[landmark as usize],
                partners: graph.of(landmark).len() as u32,
            },
        };
        Ground {
            settled: (0..graph.landmarks() as u32).map(settled).collect(),
            polished: self.polished,
            rules,
            whole: old.ground.whole,
        }
    }
}

/// Branch of each of the regions of a component, that with most landmarks first; `region` is that of each landmark,
/// by its place among `regions`.
fn by_size(regions: &[u32], region: &[u32], branches: &[u32]) -> Vec<u32> {
    let branch = |place: usize| branches[regions[place] as usize];
    let mut known: Vec<u32> = (0..regions.len()).map(branch).collect();
    known.sort_unstable();
    known.dedup();
    let place = |branch: u32| known.binary_search(&branch).expect("it is in (bug in covimap)");
    let mut sizes = vec![0_usize; known.len()];
    region.iter().for_each(|&region| sizes[place(branch(region as usize))] += 1);
    let mut order: Vec<usize> = (0..known.len()).collect();
    order.sort_by_key(|&place| Reverse(sizes[place]));
    let mut rank = vec![0; known.len()];
    (0..).zip(order).for_each(|(number, place)| rank[place] = number);
    (0..regions.len()).map(|at| rank[place(branch(at))]).collect()
}
