//! A priority queue whose entries can be changed and removed.

/// Order of expansion: first number, then second.
pub type Key = (f64, f64);

/// Not in the queue.
const ABSENT: usize = usize::MAX;

/// Binary heap of nodes with the place of every node in it.
#[derive(Clone, Debug)]
pub struct Queue {
    heap: Vec<(Key, usize)>,
    place: Vec<usize>,
}

impl Queue {
    /// An empty queue for nodes below a number.
    #[must_use]
    pub fn new(nodes: usize) -> Self {
        Self {
            heap: Vec::new(),
            place: vec![ABSENT; nodes],
        }
    }

    /// The node with the smallest key.
    #[must_use]
    pub fn first(&self) -> Option<(Key, usize)> {
        self.heap.first().copied()
    }

    /// Inserts a node, or changes its key.
    pub fn set(&mut self, node: usize, key: Key) {
        let place = self.place[node];
        if place == ABSENT {
            self.heap.push((key, node));
            self.rise(self.heap.len() - 1);
        } else {
            self.heap[place].0 = key;
            let place = self.rise(place);
            self.sink(place);
        }
    }

    /// Removes a node if it is there.
    pub fn remove(&mut self, node: usize) {
        let place = self.place[node];
        if place == ABSENT {
            return;
        }
        self.place[node] = ABSENT;
        self.heap.swap_remove(place);
        if place < self.heap.len() {
            let place = self.rise(place);
            self.sink(place);
        }
    }

    fn rise(&mut self, mut place: usize) -> usize {
        let entry = self.heap[place];
        while place > 0 {
            let above = (place - 1) / 2;
            if self.heap[above].0 <= entry.0 {
                break;
            }
            self.put(place, self.heap[above]);
            place = above;
        }
        self.put(place, entry);
        place
    }

    fn sink(&mut self, mut place: usize) {
        let entry = self.heap[place];
        loop {
            let mut below = 2 * place + 1;
            if below >= self.heap.len() {
                break;
            }
            if below + 1 < self.heap.len() && self.heap[below + 1].0 < self.heap[below].0 {
                below += 1;
            }
            if entry.0 <= self.heap[below].0 {
                break;
            }
            self.put(place, self.heap[below]);
            place = below;
        }
        self.put(place, entry);
    }

    fn put(&mut self, place: usize, entry: (Key, usize)) {
        self.place[entry.1] = place;
        self.heap[place] = entry;
    }
}
