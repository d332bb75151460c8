"""The paper's implicit neural representation and its network: what the scatterer field is compared with."""
