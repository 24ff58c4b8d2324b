//! Which elements of a rod stand side by side.

use crate::lanes::LANES;

/// Most elements of a rod that is cut into segments: they need a quarter more memory, and in long rods memory is what
/// takes time.
const MOST_IN_SEGMENTS: usize = 16_384;

/// Elements by groups of four.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Four that follow each other, from the last element to the first if `backwards`.
    InOrder {
        /// Of the rod.
        elements: usize,
        /// Whether the first group has the last elements.
        backwards: bool,
    },
    /// One of each of four segments of the rod.
    Segments {
        /// Of the rod.
        elements: usize,
    },
}

impl Layout {
    /// Segments where they pay.
    pub fn segments(elements: usize) -> Option<Self> {
        (elements <= MOST_IN_SEGMENTS).then_some(Self::Segments { elements })
    }

    fn count(self) -> usize {
        match self {
            Self::InOrder { elements, .. } | Self::Segments { elements } => elements,
        }
    }

    /// Groups of four.
    pub fn groups(self) -> usize {
        self.count().div_ceil(LANES)
    }

    /// The elements where segments start, and the end of the last; the first are longer by one where the number of
    /// elements is no multiple of four.
    pub fn bounds(self) -> Vec<usize> {
        let (elements, lanes) = (self.count(), self.count().min(LANES));
        (0..=lanes).map(|lane| lane * (elements / lanes) + lane.min(elements % lanes)).collect()
    }

    /// The elements of a group; lanes that have none are at the end and repeat another.
    pub fn elements(self, group: usize) -> [usize; LANES] {
        let mut result = [0; LANES];
        for (lane, element) in result.iter_mut().enumerate() {
            *element = match self {
                Self::InOrder { elements, backwards } => {
                    let place = (group * LANES + lane).min(elements - 1);
                    if backwards { elements - 1 - place } else { place }
                }
                Self::Segments { elements } => {
                    let (length, longer) = (elements / LANES, elements % LANES);
                    (lane * length + lane.min(longer) + group).min(elements - 1)
                }
            };
        }
        result
    }

    /// Lanes of a group, from the first, that have elements of their own.
    pub fn lanes(self, group: usize) -> usize {
        (self.count() - group * LANES).min(LANES)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_element_stands_in_one_lane() {
        for elements in 1..=23 {
            let in_order = |backwards| Layout::InOrder { elements, backwards };
            for layout in [in_order(false), in_order(true), Layout::Segments { elements }] {
                let of = |group| layout.elements(group)[..layout.lanes(group)].to_vec();
                let mut all: Vec<usize> = (0..layout.groups()).flat_map(of).collect();
                all.sort_unstable();
                assert_eq!(all, (0..elements).collect::<Vec<_>>(), "{layout:?}");
            }
            let layout = Layout::Segments { elements };
            let bounds = layout.bounds();
            assert_eq!((bounds[0], bounds.last()), (0, Some(&elements)));
            for (lane, ends) in bounds.windows(2).enumerate() {
                for (group, element) in (ends[0]..ends[1]).enumerate() {
                    assert_eq!(layout.elements(group)[lane], element, "{elements}");
                }
            }
        }
    }
}
