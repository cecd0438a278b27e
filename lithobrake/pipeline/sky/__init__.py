"""What landers at rest see of the sky."""
