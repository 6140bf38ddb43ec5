//! SCENE: what the user writes.
