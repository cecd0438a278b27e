"""The table of the study file that says which ends of a landing are asked for."""

from typing import Annotated, Any

from pydantic import ConfigDict, Field

from lithobrake.study.limit_state import LimitStateText
from lithobrake.study.section import Section


class LimitStatesSection(Section):
    """Conditions whose probability the study tells, by names of your own: fast = "speed_out > 0.1 and not returns".

    Outputs of the touchdown [SI] stand in comparisons; returns, captured, impact, flying, escaped and partner are true
    or false (docs/reliability.md). With design.method = "drawn" only."""

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, Annotated[str, LimitStateText()]] = Field(init=False)

    def conditions(self) -> dict[str, str]:
        """The conditions by their names."""
        given: dict[str, Any] = self.__pydantic_extra__ or {}
        return dict(given)
