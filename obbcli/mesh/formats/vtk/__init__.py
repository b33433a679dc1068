"""The VTK family, through VTK itself behind guards."""
