//! The pipeline: scene → bodies → condensation → outer loop → recovery → judge.
