"""The table of the study file that says which ends of a landing are asked for."""

from typing import Annotated, Any

from pydantic import BeforeValidator, ConfigDict, Field

from lithobrake.study.quantity import refuse
from lithobrake.study.section import Section
from lithobrake.vocabulary.limit_state import ALLOWED, EXAMPLE, LimitState, NoLimitStateError


def condition_text(given: object) -> str:
    """Give back the text of a condition; refuse what is none."""
    if not isinstance(given, str):
        raise refuse(given, ALLOWED, f"write it in quotation marks, as in {EXAMPLE}")
    try:
        return LimitState.of(given).text
    except NoLimitStateError as error:
        raise refuse(given, ALLOWED, str(error)) from error


class LimitStatesSection(Section):
    """Conditions whose probability the study tells, by names of your own: fast = "speed_out > 0.1 and not returns".

    Outputs of the touchdown [SI] stand in comparisons; returns, captured, impact, flying, escaped and partner are true
    or false (docs/reliability.md). With design.method = "drawn" only."""

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, Annotated[str, BeforeValidator(condition_text)]] = Field(init=False)

    def conditions(self) -> dict[str, str]:
        """The conditions by their names."""
        given: dict[str, Any] = self.__pydantic_extra__ or {}
        return dict(given)
