#pragma once

namespace roevo {

/// Least-squares line v = at_zero + slope s.
template <class T>
class LineFit {
  public:
    void add(T s, T v) {
        count_ += 1;
        s_ += s;
        v_ += v;
        ss_ += s * s;
        sv_ += s * v;
    }
    /// count^2 times the variance of s: nothing can be told when this is about 0.
    T spread() const { return count_ * ss_ - s_ * s_; }
    /// What spread() is a small difference of.
    T magnitude() const { return count_ * ss_; }
    T slope() const { return (count_ * sv_ - s_ * v_) / spread(); }
    T atZero() const { return (v_ * ss_ - s_ * sv_) / spread(); }

  private:
    T count_ = 0, s_ = 0, v_ = 0, ss_ = 0, sv_ = 0;
};

}  // namespace roevo
