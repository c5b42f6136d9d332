"""What the files of a run folder are called.

A result is a JSON document of its kind, written last; beside it lie tables, a ship or a trained model, and until it is
there what the run would be continued from.
"""

FIT = "fit.json"
SWEEP = "sweep.json"
LEFT_OUT = "leave_out.json"
DIAGNOSIS = "diagnosis.json"
VOYAGES = "voyages.json"
LEARNING = "learning.json"
ENSEMBLE = "ensemble.json"
HYBRID = "hybrid.json"
MIXTURE = "mixture.json"
POSTERIOR = "posterior.json"
VALIDATION = "validate.json"
CHECKED = "checked.json"
SIMULATION = "simulate.json"
PREDICTION = "predict.json"
PLAN = "plan.json"
COMPARISON = "comparison.json"
MODEL_COMPARISON = "model_comparison.json"
HEADING_STUDY = "heading_keeping.json"
FLEET = "fleet.json"

PROFILE = "profile.toml"
"""The ship that a fit or a diagnosis found."""

CALM = "calm.toml"
"""The same without what was of the day, such as a current."""

PARTICLES = "particles.parquet"
MODEL = "model.safetensors"
"""What was trained."""

MOTIONS = "motions.parquet"
"""Tracks that a report draws."""

HISTORY = "history.parquet"
"""Generations of an evolution strategy."""

BANDS, TRACKS, PATHS = "bands.parquet", "tracks.parquet", "paths.parquet"
"""Of a prediction: bands over time, tracks of some particles, and all of all of them."""

WINDOWS, DRAWN_WINDOWS = "windows.parquet", "drawn.parquet"
"""Of a validation on voyages."""

DRAWN = "drawn"
"""Folder inside that of a simulation, which holds trial files, with what only its report needs."""

CHECKPOINT = "checkpoint.npz"
JOURNAL, POSTERIOR_JOURNAL = "journal.jsonl", "posterior.journal.jsonl"
CHECKPOINTS = "training-*.safetensors"
"""What is left of a training that was stopped before it had a result."""

REPORT_HTML, REPORT_MARKDOWN, FIGURES = "report.html", "report.md", "figures"
DRAWN_UP = (f"{REPORT_HTML} and .md", FIGURES)
"""What a report adds, as a plan says it."""

JOBS, JOB, INFORMATION = "jobs.json", "job.json", "information.json"
"""Of a fleet: its jobs, one of them, and what the trials of one say of coefficients."""
