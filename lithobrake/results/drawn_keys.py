"""What every key means that only the summary of a drawn study has; docs/summary.md is made of it."""

from lithobrake.results.summary_keys import COUNTED, QUANTILES, SUMMARY, KeyTable

OF = "which landings it describes, in words"
PART = {
    "share": "of the variance; free of bias, so it may be a little below 0",
    "lower": "lower bound (90 %)",
    "upper": "upper bound (90 %)",
}
DRAWN_TABLES = (
    KeyTable(
        SUMMARY,
        ("results.runs",),
        "The runs of a drawn study",
        {
            "count": "runs of the sequence",
            "beds": "beds that they came down on",
            "outcomes.*": "runs that ended so; failed: runs without an outcome",
            "missing.count": "runs without an outcome: left the bed laterally, at the time limit, or failed",
            "missing.share": "the same as a share of count",
            "missing.outcomes": "none where every run has an outcome",
            "missing.outcomes.*": "of these, runs that ended so",
            "warning": "where more than 2 % of the runs have no outcome: how many, why, what they leave undescribed, "
            "and how to avoid it, in a sentence; else null",
            "over_rim": "of those that left: runs that crossed the edge of the bed in flight, touching nothing and "
            "going up",
            "side_runs": "null without design.side_runs",
            "side_runs.soil_pairs": "runs again on a second soil",
            "side_runs.twins": "runs again a little beside",
            "side_runs.twin_shift": "how far beside [m]",
            "side_runs.soil_total_effect.*.share": "share of the variance of the output that goes with the soil, "
            "interactions with bed, place and attitude included",
            "side_runs.chaos_deviation.*.value": "standard deviation that chaos alone gives, in the output's unit",
            **{f"side_runs.*.*.{end}": "its 90 % interval" for end in ("lower", "upper")},
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.variance_shares.*",),
        "Where the scatter of an output of a drawn study comes from (docs/estimates.md); null where the runs cannot "
        "tell, and with design.method = paper. returns: of the share of its flights for which a run returns",
        {
            "soil": "inputs of grains and surface, and of the lander's contacts: part",
            "soil_by_input.*": "one of them alone: part",
            "arrival": "all other inputs, as speed, incidence and mass: part; null where none is uncertain",
            "bed": "what landings on one bed have in common: part",
            "place_and_attitude": "everything else, impact point, attitude, lack of fit and interactions with the "
            "soil: part",
            "chaos": "what twins differ in: part; null without side runs",
            **{f"{part}.{key}": words for part in ("*", "soil_by_input.*") for key, words in PART.items()},
            "of": OF,
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.outputs.*",),
        "Each output over the runs of a drawn study that have it, in its unit. azimuth_out, which has neither "
        "beginning nor end, has mean_direction and resultant_length in place of mean, quantiles and standard deviation",
        {
            "of": OF,
            **{f"{name}.value": words for name, words in (("mean", "mean"), ("quantiles.*", QUANTILES))},
            "mean_direction.value": "direction of the mean of the unit vectors [rad]; its bounds may lie beyond pi",
            "resultant_length.value": "length of that mean: 0 where directions cancel, 1 where all are alike",
            **{
                f"{name}.{end}": "its 90 % interval; null where there is none"
                for name in ("mean", "quantiles.*", "mean_direction", "resultant_length")
                for end in ("lower", "upper")
            },
            "standard_deviation": "of the runs",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.shares.emulator",),
        "The same by the samples of the emulator, up to the last that flew, as shares of all of these, for comparison; "
        "outside: sampled with an elevation or speed that there is not; missing: left_sideways, time_limit, outside",
        {
            "sample_count": "samples looked at",
            "flight_count": "of those, samples that flew",
            **COUNTED,
            "why": "why the shares have no interval, in a sentence; null where they have one",
            "level": "probability that the bounds stand for",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.limit_states.*",),
        "Each limit state of the study file (docs/reliability.md); none where it has no table [limit_states]",
        {
            "condition": "as the study file has it",
            "probability": "share of the landers that meet it, over the laws of the study file",
            "lower": "lower bound, over beds and places not in the study; null where why says that there is none",
            "upper": "upper bound likewise",
            "level": "probability that bounds of this table stand for",
            "source": "what answers: runs, or the emulator where it is so rare (or so sure) that runs do not",
            "runs.*": "the same by the runs, whichever answers: keys of results.returns",
            "emulator": "null where the emulator cannot tell",
            "emulator.*": "the same by the emulator",
            "tail_limit": "largest probability of an event that no run on so many beds has met",
            "failing_runs": "runs that meet it; of those whose flights meet it in part, their shares",
            "inputs": "none where no run meets it, or all came down on one bed",
            "inputs.*.distance": "largest difference of the distribution functions of the input among the runs that "
            "meet it and by its law",
            "inputs.*.lower": "lower bound, by drawing the beds anew",
            "inputs.*.upper": "upper bound likewise",
            "inputs.*.luck": "distance that luck alone passes in one of ten studies, all inputs together",
            "inputs.*.median": "of the input among the runs that meet it, in its unit",
            "inputs.*.median_of_all": "of its law",
            "inputs.*.found": "whether the distance is above luck",
            "why": "why there is no interval, in a sentence; null where there is one",
            "statement": "all of it in a sentence",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.aim",),
        "The aims of the study file (docs/aiming.md), the last name running fastest",
        {
            "names": "what is aimed at, by dotted key, in the order of aims.values",
            "units": "of the names",
            "within": "limits that the best aim keeps",
            "lander_count": "landers at each aim",
            "refit_count": "fits of the emulator to beds drawn anew that they share in",
            "level": "probability that the bounds of this table stand for",
            "why": "why the soil gives no interval, in a sentence; null where it gives one",
            "aims.values": "of the names, in the units of the study file",
            **{
                f"aims.{ground}.{key}": words
                for ground, bounds in (("soil", "over refits"), ("hard", "by the number of landers"))
                for key, words in {
                    "settled.share": "landers that rest where the ground holds them, after all bounces",
                    "settled.lower": f"lower bound, {bounds}; null where there is none",
                    "settled.upper": "upper bound likewise",
                    "missing": "share of the landers with an unknown outcome",
                    "distance_p95": "null where no lander settles",
                    "distance_p95.value": "95 % of those that settle lie within this way over the ground [m]",
                    "time_p95": "null where no lander settles",
                    "time_p95.value": "95 % of those that settle rest within this time [s]",
                    **{
                        f"{name}.{end}": f"{end} bound; null where so few landers do not tell it"
                        for name in ("distance_p95", "time_p95")
                        for end in ("lower", "upper")
                    },
                    "allowed": "whether the aim keeps the limits on this ground",
                }.items()
            },
            "aims.soil.share_of_refits": "share of the refits in which most landers settle here",
            **{
                f"best_on_{ground}{key}": words
                for ground in ("soil", "hard")
                for key, words in {
                    "": "null where no aim is allowed, or at none of them a lander settles",
                    ".aim": "place of the best among the aims, from 0",
                    ".share_of_refits": "share of the refits in which it is the best, no probability that it is; null "
                    "on hard ground",
                    ".own": "null on hard ground, and where refits tell nothing",
                    ".own.share": "settled share of the best less what its selection among the aims adds",
                    ".own.lower": "lower bound of that, over refits",
                    ".own.upper": "upper bound likewise",
                    ".not_worse": "places of the other allowed aims that cannot be distinguished from the best at the "
                    "level, all of them together; null on hard ground, and where refits tell nothing",
                    ".next": "place of the second best likewise",
                    ".difference": "null where there is no second, and on hard ground",
                    ".difference.value": "settled share of the best less that of the second",
                    ".difference.lower": "lower bound of that, over refits",
                    ".difference.upper": "upper bound likewise",
                }.items()
            },
            "statement": "the best aim and how sure it is, in sentences",
        },
    ),
    KeyTable(
        SUMMARY,
        ("results.emulator",),
        "The emulator of a drawn study, on beds that were left out (docs/emulator.md)",
        {
            "of": OF,
            "statement": "what it makes of the inputs, in a sentence",
            "follows_inputs": "whether draws depend on the inputs; else each is one of the runs",
            "found_inputs": "inputs that change a mean, alone or by products: one test of 90 % for all",
            "scores.joint.energy_skill": "1 - energy score over that of drawing runs, all outputs together",
            "scores.*.crps_skill": "1 - CRPS over that of drawing runs, whatever the inputs",
            "scores.*.band_90": "share of runs inside the middle 90 % of what was foretold",
            "scores.*.pit": "runs by where in its foretold distribution each lay, in ten steps",
            "warning": "that its share lies outside the interval of the runs, in a sentence; null where it does not",
        },
    ),
)
