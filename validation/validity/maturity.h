// What a run knows of the maturity of a prediction, by element; levels are for a person to judge.
//
// PCMM: W. Oberkampf, M. Pilch, T. Trucano, Predictive Capability Maturity Model for Computational Modeling and
// Simulation, SAND2007-5948, six elements. NASA-STD-7009 (2008), Standard for Models and Simulations, eight factors of
// credibility.
#pragma once

#include <string>
#include <vector>

namespace deflect::validity {

struct MaturityRow {
  const char* scheme;  ///< "PCMM", "NASA-STD-7009"
  const char* element;
  std::string known;  ///< of this run, a sentence with numbers; empty where only a person can judge
};

struct ValidationStudy;
std::vector<MaturityRow> maturity(const ValidationStudy&);

}  // namespace deflect::validity
