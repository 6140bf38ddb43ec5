//! Which facets carry the contacts together, in 3D.
//!
//! A facet with three or four contacts at its corners carries its own cover with their functions (C21).
//! One that has lost corners gives its cover to the neighbour over an edge, whose contacts have moved out over it.
//! Where there is no such neighbour, or where the functions would leave a contact no area, all of the cover goes
//! to the nearest contact, with its force at the middle of the cover.

use std::collections::{BTreeMap, HashMap};

use super::super::turn::CORNER;
use super::coverage::{Coverage, WHOLE};
use super::patch::{MOST_CONTACTS, Member, Patch, Stand};
use super::polygon::{self, Point, Polygon};
use super::quadrature::integrate;
use super::spread::Spread;
use super::standing::{Place, places};
use super::ties::{EQUAL, first_largest};
use super::tile::Tile;

/// Part of a node's tributary area that is none.
const NO_AREA: f64 = 0.02;

/// Gauss points per direction for the mean of what is quadratic.
const QUADRATIC: usize = 3;

/// The covered facets of side 1, with the functions of their contacts.
pub(super) fn patches(coverage: &Coverage<'_>) -> Vec<Patch> {
    let shares = (0..coverage.one.facets.len()).map(|facet| (facet, coverage.share(facet)));
    let met: Vec<_> = shares.filter(|(_, share)| *share > 0.0).collect();
    if met.iter().all(|(_, share)| *share >= 1.0 - WHOLE) {
        let whole =
            |(facet, _): &(usize, f64)| Patch::whole(*facet, coverage.one.corners_of(*facet));
        return met.iter().map(whole).collect();
    }
    let tiles = met
        .iter()
        .filter_map(|(facet, _)| Tile::of(coverage, *facet));
    Tiling::new(coverage, tiles.collect()).patches()
}

/// All covered facets.
struct Tiling<'a> {
    coverage: &'a Coverage<'a>,
    tiles: Vec<Tile>,
    places: HashMap<usize, Place>,
    /// The tile that carries each tile's cover.
    carriers: Vec<usize>,
}

/// Tiles that are carried together.
struct Group {
    /// Their indices; the first one carries.
    tiles: Vec<usize>,
    /// Their contacts' nodes.
    contacts: Vec<usize>,
    /// The functions; none if the cover goes to a single contact.
    spread: Option<Spread>,
    /// Area of the cover in m², and its centre in the carrier's plane.
    area: f64,
    centre: Point,
}

impl<'a> Tiling<'a> {
    fn new(coverage: &'a Coverage<'a>, tiles: Vec<Tile>) -> Self {
        let places = places(coverage.one, &tiles);
        let mut tiling = Self {
            coverage,
            carriers: (0..tiles.len()).collect(),
            tiles,
            places,
        };
        tiling.join();
        tiling
    }

    fn corners(&self, tile: usize) -> &'a [usize] {
        self.coverage.one.corners_of(self.tiles[tile].facet)
    }

    fn edges(&self, tile: usize) -> impl Iterator<Item = [usize; 2]> {
        self.coverage.edges_of(self.tiles[tile].facet)
    }

    /// The corners of a tile that have a contact.
    fn contacts(&self, tile: usize) -> Vec<usize> {
        let corners = self.corners(tile).iter().copied();
        corners.filter(|node| !self.places[node].gone).collect()
    }

    /// Whether a tile's contacts stand at its corners and all of it is covered.
    fn is_plain(&self, tile: usize) -> bool {
        let stays = |node: &usize| self.places[node].moved.is_none() && !self.places[node].gone;
        self.tiles[tile].is_whole() && self.corners(tile).iter().all(stays)
    }

    fn points(&self, tile: usize, contacts: &[usize]) -> Vec<Point> {
        let view = &self.tiles[tile].view;
        let places = contacts.iter().map(|node| self.places[node].at);
        places.map(|at| view.coordinates(at)).collect()
    }

    /// The contacts of a tile that have functions for a cover of so large an area about a centre: all of them,
    /// or of four the best three.
    fn spread(&self, tile: usize, area: f64, centre: Point) -> Option<(Vec<usize>, Spread)> {
        let contacts = self.contacts(tile);
        let of = |contacts: Vec<usize>| {
            let spread = Spread::new(&self.points(tile, &contacts), area)?;
            Some((contacts, spread))
        };
        if let Some(found) = of(contacts.clone()) {
            return Some(found);
        }
        let without = |left_out: &usize| {
            let kept = contacts.iter().copied().filter(|node| node != left_out);
            of(kept.collect())
        };
        let least = |(_, spread): &(Vec<usize>, Spread)| {
            let values = spread.linear(centre).into_iter().take(3);
            values.fold(f64::INFINITY, f64::min)
        };
        first_largest(contacts.iter().filter_map(without), least)
    }

    /// Gives the cover of tiles without enough contacts to their neighbours.
    fn join(&mut self) {
        let carries = |tile: &usize| {
            let cover = &self.tiles[*tile].polygons;
            let (area, centre) = middle(cover);
            self.is_plain(*tile) || self.spread(*tile, area, centre).is_some()
        };
        let tiles = 0..self.tiles.len();
        let mut done: Vec<bool> = tiles.clone().map(|tile| carries(&tile)).collect();
        let mut open: Vec<usize> = tiles.filter(|tile| !done[*tile]).collect();
        if open.is_empty() {
            return;
        }
        let beside = self.beside();
        loop {
            let found = |tile: &usize| Some((*tile, self.carrier(*tile, &beside, &done)?));
            let joined: Vec<_> = open.iter().filter_map(found).collect();
            if joined.is_empty() {
                return;
            }
            for (tile, carrier) in joined {
                self.carriers[tile] = carrier;
                done[tile] = true;
            }
            open.retain(|tile| !done[*tile]);
        }
    }

    /// The tiles on both sides of each edge.
    fn beside(&self) -> HashMap<[usize; 2], Vec<usize>> {
        let mut beside: HashMap<_, Vec<usize>> = HashMap::new();
        for tile in 0..self.tiles.len() {
            for edge in self.edges(tile) {
                beside.entry(edge).or_default().push(tile);
            }
        }
        beside
    }

    /// What carries the neighbour with the largest covered part, if any goes on without a corner.
    fn carrier(
        &self,
        tile: usize,
        beside: &HashMap<[usize; 2], Vec<usize>>,
        done: &[bool],
    ) -> Option<usize> {
        let normal = self.tiles[tile].view.normal;
        let goes_on = |other: &usize| {
            done[*other] && self.tiles[*other].view.normal.dot(&normal) > CORNER.cos()
        };
        let neighbours = self
            .edges(tile)
            .flat_map(|edge| beside[&edge].iter().copied());
        let share = |tile: &usize| self.tiles[*tile].share;
        // Several are covered whole: of these the one that is nearest.
        let near = |other: &usize| {
            let own = middle(&self.tiles[tile].polygons).1;
            let there = middle(&self.cover(*other, tile)).1;
            -(there - own).norm()
        };
        let candidates: Vec<usize> = neighbours.filter(goes_on).collect();
        let most = candidates.iter().map(share).fold(0.0, f64::max);
        let best = candidates
            .into_iter()
            .filter(|tile| share(tile) >= most - EQUAL);
        first_largest(best, near).map(|best| self.carriers[best])
    }

    fn patches(&self) -> Vec<Patch> {
        let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (tile, carrier) in self.carriers.iter().enumerate() {
            members.entry(*carrier).or_insert(vec![*carrier]);
            if tile != *carrier {
                members.entry(*carrier).or_default().push(tile);
            }
        }
        let mut groups: Vec<Group> = members
            .into_values()
            .map(|tiles| self.group(tiles))
            .collect();
        self.refuse(&mut groups);
        groups.iter().map(|group| self.patch(group)).collect()
    }

    fn group(&self, tiles: Vec<usize>) -> Group {
        let carrier = tiles[0];
        let cover: Vec<Polygon> = tiles
            .iter()
            .flat_map(|tile| self.cover(*tile, carrier))
            .collect();
        let (area, centre) = middle(&cover);
        let mean = |of: &dyn Fn(Point) -> f64| self.mean(&tiles, of);
        let (contacts, spread) = match self.spread(carrier, area, centre) {
            Some((contacts, spread)) => (contacts, Some(spread.balanced(mean))),
            None => (self.contacts(carrier), None),
        };
        Group {
            contacts,
            spread,
            area: area * self.tiles[carrier].view.unit,
            centre,
            tiles,
        }
    }

    /// A tile's cover in the plane of another one.
    fn cover(&self, tile: usize, carrier: usize) -> Vec<Polygon> {
        let (own, view) = (&self.tiles[tile], &self.tiles[carrier].view);
        if tile == carrier {
            return own.polygons.clone();
        }
        let seen = |at: &Point| view.coordinates(own.view.position([at.x, at.y, 0.0]));
        let polygons = own.polygons.iter();
        polygons
            .map(|polygon| polygon.iter().map(seen).collect())
            .collect()
    }

    /// The mean over the cover of tiles of what goes between its values at their corners.
    fn mean(&self, tiles: &[usize], of: &dyn Fn(Point) -> f64) -> f64 {
        let (mut sum, mut area) = (0.0, 0.0);
        for &tile in tiles {
            let own = &self.tiles[tile];
            let values = self.at_corners(tile, tiles[0]).map(of);
            let values: Vec<f64> = values.collect();
            for polygon in &own.polygons {
                integrate(polygon, QUADRATIC, |at, share| {
                    let terms = own.outline.shape(at).into_iter().zip(&values);
                    sum +=
                        terms.map(|(hat, value)| hat * value).sum::<f64>() * share * own.view.unit;
                    area += share * own.view.unit;
                });
            }
        }
        sum / area
    }

    /// A tile's corners in the plane of another one.
    fn at_corners(&self, tile: usize, carrier: usize) -> impl Iterator<Item = Point> {
        let nodes = &self.coverage.one.mesh.nodes;
        let view = &self.tiles[carrier].view;
        let corners = self.corners(tile).iter();
        corners.map(|node| view.coordinates(nodes[*node].into()))
    }

    /// Takes the functions from groups that would leave a contact no area.
    fn refuse(&self, groups: &mut [Group]) {
        let mut support: HashMap<usize, f64> = HashMap::new();
        for (index, tile) in self.tiles.iter().enumerate() {
            let corners = self.corners(index);
            for node in corners {
                *support.entry(*node).or_default() += tile.area / corners.len() as f64;
            }
        }
        loop {
            let mut areas: HashMap<usize, f64> = HashMap::new();
            for (node, area) in groups.iter().flat_map(Group::areas) {
                *areas.entry(node).or_default() += area;
            }
            let lost = |node: usize| areas[&node] < NO_AREA * support[&node];
            let negative =
                |group: &&mut Group| group.areas().any(|(node, area)| area < 0.0 && lost(node));
            let mut refused = false;
            for group in groups.iter_mut().filter(negative) {
                group.spread = None;
                refused = true;
            }
            if !refused {
                return;
            }
        }
    }

    fn patch(&self, group: &Group) -> Patch {
        let carrier = group.tiles[0];
        let corners = self.corners(carrier);
        if group.tiles.len() == 1 && self.is_plain(carrier) {
            return Patch::whole(self.tiles[carrier].facet, corners);
        }
        let Some(spread) = &group.spread else {
            return self.single(group);
        };
        let members = group.tiles.iter().map(|&tile| {
            let mut values = [[0.0; 4]; MOST_CONTACTS];
            for (corner, at) in self.at_corners(tile, carrier).enumerate() {
                for (row, value) in values.iter_mut().zip(spread.values(at)) {
                    row[corner] = value;
                }
            }
            self.member(tile, values)
        });
        Patch {
            stands: group
                .contacts
                .iter()
                .map(|node| self.stand(*node))
                .collect(),
            members: members.collect(),
            shares: self.shares(group),
        }
    }

    /// Corners' shares in where the contacts of a single triangle stand.
    fn shares(&self, group: &Group) -> Option<[[f64; 4]; MOST_CONTACTS]> {
        let [tile] = group.tiles[..] else {
            return None;
        };
        let mut shares = [[0.0; 4]; MOST_CONTACTS];
        for (row, at) in shares.iter_mut().zip(self.points(tile, &group.contacts)) {
            *row = self.tiles[tile].outline.shape(at);
        }
        (self.corners(tile).len() == 3).then_some(shares)
    }

    /// All to the contact that is nearest to the middle of the cover.
    fn single(&self, group: &Group) -> Patch {
        let carrier = group.tiles[0];
        let contacts = match group.contacts.is_empty() {
            true => self.corners(carrier),
            false => &group.contacts[..],
        };
        let points = self.points(carrier, contacts);
        let distance = |at: &Point| (at - group.centre).norm_squared();
        let nearest = contacts.iter().zip(points);
        let nearest = nearest.min_by(|a, b| distance(&a.1).total_cmp(&distance(&b.1)));
        let mut one = [[0.0; 4]; MOST_CONTACTS];
        one[0] = [1.0; 4];
        let members = group.tiles.iter().map(|tile| self.member(*tile, one));
        Patch {
            stands: nearest.iter().map(|(node, _)| self.stand(**node)).collect(),
            members: members.collect(),
            shares: None,
        }
    }

    fn member(&self, tile: usize, values: [[f64; 4]; MOST_CONTACTS]) -> Member {
        Member {
            facet: self.tiles[tile].facet,
            values,
        }
    }

    fn stand(&self, node: usize) -> Stand {
        Stand {
            node,
            moved: self.places[&node].moved,
        }
    }
}

impl Group {
    /// The contacts' areas in m².
    fn areas(&self) -> impl Iterator<Item = (usize, f64)> {
        let shares = self
            .spread
            .as_ref()
            .map(|spread| spread.linear(self.centre));
        let areas = shares.into_iter().flatten().map(|share| share * self.area);
        self.contacts.iter().copied().zip(areas)
    }
}

/// Area and centre of a cover.
fn middle(cover: &[Polygon]) -> (f64, Point) {
    let area = cover.iter().map(|polygon| polygon::area(polygon)).sum();
    let moments = cover
        .iter()
        .map(|polygon| polygon::centroid(polygon) * (polygon::area(polygon) / area));
    (area, moments.sum())
}
