"""What every key of the scores and the expansions of a study means; docs/summary.md is made of it."""

from lithobrake.results.summary_keys import KeyTable

SCORES, EXPANSIONS = "scores.json", "screening.json, refined.json"
FIT_TABLES = (
    KeyTable(
        SCORES,
        ("*.*",),
        "By set of runs and output; in the summary too, but for ape",
        {
            "ape": "absolute percentage error of every run [%]; null where the true value is 0",
            "mape": "mean of those [%]; null where one is null",
            "q2": "explained share of the variance, 1 - rrmse squared; null where the runs do not vary",
            "rrmse": "rmse over std; null where the runs do not vary",
            "rmse": "root-mean-square error, in the unit of the output",
            "std": "standard deviation of the runs, in the unit of the output",
            "*_interval": "95 % interval, by drawing the runs anew: lower, upper; null: no such end",
        },
    ),
    KeyTable(
        EXPANSIONS,
        ("",),
        "The file (lithobrake.chaos.load reads it)",
        {
            "format": "says that this is an expansion",
            "format_version": "of the file",
            "written_by": "version of lithobrake",
            "inputs.*": "name, kind and parameters of the distribution of each input, in the file's units",
            "output_names": "columns of coefficients and residuals",
            "one_dimensional": "whether y had one dimension",
            "multi_indices": "degrees of each term, one column an input",
            "coefficients": "of the orthonormal terms, one column an output",
            "residuals": "what each run is off the expansion, one column an output",
        },
    ),
    KeyTable(
        EXPANSIONS,
        ("report",),
        "How the expansion was fitted",
        {
            "method": "asked for, or best of each output",
            "rrmse_estimate": "of each output, in their order: outputs.*.rrmse_estimate",
            "degree": "highest total degree of a term",
            "train_count": "runs that were fitted",
            "dropped_count": "runs left out, as they have no outputs",
            "data_hash": "hash of the inputs and outputs that were fitted",
            "candidates.*.*": "error that each way of fitting promises at a new run, in the unit of the output",
            "challenger.model": "a Gaussian process that every other way is compared with",
            "challenger.rmse_estimate.*": "error that it promises; null where it could not be fitted",
            "outputs.*.method": "how the output was fitted",
            "outputs.*.term_count": "its terms",
            "outputs.*.rmse_estimate": "root-mean-square error expected at a new run, with scatter, in its unit",
            "outputs.*.rrmse_estimate": "the same over the standard deviation of the runs; null where they do not vary",
            "outputs.*.error_estimate": "how that error was found",
            "outputs.*.condition_number": "of the least squares",
            "outputs.*.candidate_degree": "total degree of the terms that omp or lars chose from",
            "outputs.*.candidate_q_norm": "q-norm of the same terms",
            "outputs.*.covariance": "covariance of the Gaussian process",
            "outputs.*.noise_std": "standard deviation between equal runs, in the unit of the output",
            "outputs.*.noise_from": "what tells it, or null",
        },
    ),
)
