from dataclasses import dataclass


@dataclass
class TriggerResponse:
    success: bool = False
    message: str = ""


class Trigger:
    Response = TriggerResponse
