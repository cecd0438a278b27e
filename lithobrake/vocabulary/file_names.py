"""The files in a study's folder: names of those that several parts write and read, and what each holds."""

STUDY_FILE = "study.toml"
RUNS_FILE = "runs.sqlite"
SUMMARY_FILE = "summary.json"
ESTIMATES_FILE = "estimates.json"
# The preview landing, and the representative one.
LANDING_FILE, TELLING_LANDING_FILE = "landing.h5", "telling_landing.h5"
# The expansion in all inputs, in the kept ones, and their errors.
SCREENING_FILE, REFINED_FILE, SCORES_FILE = "screening.json", "refined.json", "scores.json"
EMULATOR_FILE, EXPLORER_FILE = "emulator.json", "explorer.h5"
# The same of all touchdowns of journeys.
TOUCHDOWN_EMULATOR_FILE, TOUCHDOWN_EXPLORER_FILE = "touchdown_emulator.json", "touchdown_explorer.h5"
# Samples of an emulator or expansion, their flights to the next impact, and their journeys from bounce to bounce.
SAMPLES_FILE, SAMPLE_FLIGHTS_FILE, FLIGHT_CHECKS_FILE = "samples.h5", "flights.csv", "flights.json"
REST_FILE = "rest.csv"
# One row a journey of landings, a touchdown, and a flight between impacts.
JOURNEYS_FILE, TOUCHDOWNS_FILE, ARCS_FILE = "journeys.csv", "touchdowns.csv", "arcs.csv"
SKY_FILE, AIM_FILE = "sky.csv", "aim.csv"
BODY_FILE, FLIGHTS_WITHOUT_SCATTER_FILE = "body.obj", "flights_without_scatter.csv"
# What each holds, as the page says it; names with * stand for several files.
CONTENTS = {
    STUDY_FILE: "the study file",
    SUMMARY_FILE: "every number of this page, with its unit",
    RUNS_FILE: "every touchdown: inputs, outcome, outputs, seed, times",
    "beds/bed_*.h5": "a settled bed: shapes, poses and motion",
    "designs/drawn.csv": "the first touchdowns of the landers: inputs and outputs",
    "designs/soil_pairs.csv": "drawn landings repeated on a second soil",
    "designs/twins.csv": "drawn landings repeated at a slightly shifted impact point",
    "run_flights.csv": "how the flights of each run ended, from many sites",
    "run_impacts.csv": "time, speed and incidence of the impacts that end these flights",
    ESTIMATES_FILE: "estimates from the runs, with intervals",
    LANDING_FILE: "the preview landing: shapes, poses and motion",
    TELLING_LANDING_FILE: "the landing of this page: the run with the median rebound speed",
    EMULATOR_FILE: "the emulator (lithobrake.emulator.load reads it)",
    EXPLORER_FILE: "refits of the emulator or the expansion, for the explorer of this page",
    SCREENING_FILE: "the expansion in all inputs",
    REFINED_FILE: "the expansion in the kept inputs",
    SCORES_FILE: "the errors of the expansions, run by run",
    SAMPLES_FILE: "the Monte Carlo: inputs and outputs of every sample",
    SAMPLE_FLIGHTS_FILE: "the flight of each sample that leaves the surface",
    FLIGHTS_WITHOUT_SCATTER_FILE: "the same flights without run-to-run scatter",
    FLIGHT_CHECKS_FILE: "accuracy of the flights",
    "flight_paths.h5": "paths of the first flights, as the page shows them about the body",
    JOURNEYS_FILE: "every journey: end, time, place, distance, contacts, side down",
    TOUCHDOWNS_FILE: "every landing of the journeys: its number, key, outcome, time and place",
    "designs/touchdowns.csv": "the same landings: inputs and outputs",
    TOUCHDOWN_EMULATOR_FILE: "the emulator of all touchdowns of the journeys (lithobrake.emulator.load reads it)",
    TOUCHDOWN_EXPLORER_FILE: "refits of that emulator, for the explorer of this page",
    "emulated.csv": "journeys by the emulator of the touchdowns, and how they ended",
    REST_FILE: "how each lander ended that was followed on other ground",
    ARCS_FILE: "each flight between impacts: state at the beginning, time of the end",
    "restitution.csv": "restitution, friction and scatter that the soil implies, by speed and incidence",
    "rare_*.json": "a rare limit state: its probability and the levels of its subset simulation",
    AIM_FILE: "the landers at every delivery option, and how they ended",
    BODY_FILE: "the shape of the body that the flights used",
}
