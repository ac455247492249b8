//! Nodes in the order of their times, within the least time of a link.

/// A queue of nodes: those of a bucket differ by less than the least link, so none of them improves another.
#[derive(Clone, Debug, Default)]
pub struct Buckets {
    nodes: Vec<Vec<u32>>,
    width: f32,
    next: usize,
    waiting: usize,
}

/// Most buckets: what is farther away is never reached.
const MOST: usize = 1 << 16;

impl Buckets {
    /// Empties it, for buckets of a width in s.
    pub fn restart(&mut self, width: f32) {
        for bucket in &mut self.nodes {
            bucket.clear();
        }
        self.width = width;
        self.next = 0;
        self.waiting = 0;
    }

    /// Adds a node.
    #[inline]
    pub fn push(&mut self, time: f32, node: u32) {
        let bucket = ((time / self.width) as usize).max(self.next);
        if bucket >= MOST {
            return;
        }
        if bucket >= self.nodes.len() {
            self.nodes.resize_with(bucket + 64, Vec::new);
        }
        self.nodes[bucket].push(node);
        self.waiting += 1;
    }

    /// Takes a node of the first bucket that has one.
    #[inline]
    pub fn pop(&mut self) -> Option<u32> {
        if self.waiting == 0 {
            return None;
        }
        loop {
            if let Some(node) = self.nodes.get_mut(self.next)?.pop() {
                self.waiting -= 1;
                return Some(node);
            }
            self.next += 1;
        }
    }
}
